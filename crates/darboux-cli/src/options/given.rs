//! Which options stand on the command line.

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches, Id};

/// The options that the command line gives, defaults left out. Flattened into a struct of arguments it must
/// be the first field: the others take their values away.
#[derive(Clone, Debug, Default)]
pub struct Given {
    ids: Vec<Id>,
}

impl Given {
    /// The names of these options without dashes, in the order of the command's help.
    pub fn names(&self, command: &Command) -> Vec<String> {
        let given = command.get_arguments().filter(|argument| self.ids.contains(argument.get_id()));
        given.filter_map(|argument| argument.get_long().map(str::to_owned)).collect()
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let is_given = |id: &&Id| matches.value_source(id.as_str()) == Some(ValueSource::CommandLine);
        Ok(Self { ids: matches.ids().filter(is_given).cloned().collect() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}
