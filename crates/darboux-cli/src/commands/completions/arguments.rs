//! The arguments of `darboux completions`.

use clap::Args;
use clap_complete::Shell;

pub const ABOUT: &str = "\
Print a script that completes subcommands, options and their values in a shell.

The script goes to standard output. Save it where the shell looks for completions, or load it when the shell \
starts.";

pub const EXAMPLES: &str = "\
Examples:
  darboux completions bash > ~/.local/share/bash-completion/completions/darboux
  darboux completions zsh > ~/.zfunc/_darboux          (with fpath+=~/.zfunc in .zshrc)
  darboux completions fish > ~/.config/fish/completions/darboux.fish
  darboux completions powershell >> $PROFILE";

/// Which shell.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}
