//! `darboux view`: serves the viewer's page and a model to the browser of this machine.

pub mod arguments;

mod model;
mod page;
mod server;

use std::convert::Infallible;
use std::fmt::Write as _;
use std::path::PathBuf;

use darboux_io::system_reason;

use crate::exit;
use crate::terminal::{Messages, write_stdout};
use arguments::ViewArguments;
use model::ServedModel;
use page::Page;
use server::{ServedModels, Server};

/// Serves until the process is interrupted; returns the exit code if the server cannot start.
pub fn run(arguments: &ViewArguments) -> u8 {
    let messages = Messages::new(false);
    match serve(arguments, &messages) {
        Ok(never) => match never {},
        Err(sentence) => {
            messages.error(&sentence);
            exit::FAILED
        }
    }
}

fn serve(arguments: &ViewArguments, messages: &Messages) -> Result<Infallible, String> {
    let find = |path: &Option<PathBuf>| {
        path.as_deref().map(|path| ServedModel::find(path, arguments.reading.load_options())).transpose()
    };
    let models = ServedModels { model: find(&arguments.model)?, high: find(&arguments.high)? };
    let page = Page::find(arguments.page.as_deref())?;
    let server = Server::start(page, models, secret()?)?;
    let address = server.address();
    write_stdout(format!("{address}\n").as_bytes())
        .map_err(|error| format!("the address cannot be written: {}", system_reason(&error)))?;
    if !arguments.no_open && open::that_detached(address).is_err() {
        messages.warn("no browser could be opened; open the address above in one");
    }
    messages.say("press Ctrl-C to end the viewer");
    server.run()
}

/// 128 random bits in hexadecimal, which pages of other origins cannot guess.
fn secret() -> Result<String, String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| format!("the system returned no random numbers: {error}"))?;
    Ok(bytes.iter().fold(String::new(), |mut text, byte| {
        let _never_fails = write!(text, "{byte:02x}");
        text
    }))
}
