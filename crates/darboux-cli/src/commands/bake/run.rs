//! Runs `darboux bake`: one low model, or the entries of a job.

use super::arguments::BakeArguments;
use super::job::{self, Work};
use super::single;
use crate::exit;
use crate::interrupt;
use crate::terminal::Messages;

/// Runs the command and returns its exit code.
pub fn run(arguments: &BakeArguments) -> u8 {
    let messages = Messages::new(arguments.messages.quiet);
    match job::work_of(arguments) {
        Ok(Work::Single) => single::run(&arguments.clone().completed(), &messages),
        Ok(Work::Job(job)) => {
            interrupt::wait_for_writes();
            job::run(arguments, job, &messages)
        }
        Err(sentence) => {
            messages.error(&sentence);
            exit::USAGE
        }
    }
}
