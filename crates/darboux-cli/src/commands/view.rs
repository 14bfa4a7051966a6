//! `darboux view`: serves the viewer's page and a model to the browser of this machine.

pub mod arguments;

mod model;
mod page;
mod server;

use std::fmt::Write as _;

use crate::exit;
use crate::terminal::{Messages, write_stdout};
use arguments::ViewArguments;
use model::Model;
use page::Page;
use server::Server;

/// Runs the command until it is interrupted; gives its exit code where it cannot begin.
pub fn run(arguments: &ViewArguments) -> u8 {
    let messages = Messages::new(false);
    match serve(arguments, &messages) {
        Ok(()) => exit::DONE,
        Err(sentence) => {
            messages.error(&sentence);
            exit::FAILED
        }
    }
}

fn serve(arguments: &ViewArguments, messages: &Messages) -> Result<(), String> {
    let model = arguments
        .model
        .as_deref()
        .map(|path| Model::find(path, arguments.reading.load_options()))
        .transpose()?;
    let page = Page::find(arguments.page.as_deref())?;
    let server = Server::start(page, model, secret()?)?;
    let address = server.address();
    write_stdout(format!("{address}\n").as_bytes())
        .map_err(|error| format!("the address cannot be written: {error}"))?;
    if !arguments.no_open
        && let Err(error) = open::that_detached(address)
    {
        messages.warn(&format!("no browser opens ({error}); open the address yourself"));
    }
    messages.say("Ctrl-C ends the viewer");
    server.run();
    Ok(())
}

/// What a page of another origin cannot guess: 128 random bits in hexadecimal.
fn secret() -> Result<String, String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| format!("the system gives no random numbers: {error}"))?;
    Ok(bytes.iter().fold(String::new(), |mut text, byte| {
        let _never_fails = write!(text, "{byte:02x}");
        text
    }))
}
