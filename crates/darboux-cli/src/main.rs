//! The `darboux` command.

use std::process::ExitCode;

/// Keeps Mesa's layer out, by the layer's own description.
#[cfg(target_os = "linux")]
const NO_DEVICE_SELECT: &str = "NODEVICE_SELECT";

fn main() -> ExitCode {
    #[cfg(target_os = "linux")]
    leave_the_desktop();
    ExitCode::from(darboux_cli::run(std::env::args_os()))
}

/// Starts this program again, without Mesa's Vulkan layer that asks the desktop for its adapter, where there is no desktop: its Wayland
/// library would complain on standard error whenever adapters are looked for. The loader reads the variable, which threads may read while
/// it is set here, so that only a new process can have it. Where that fails, the complaints are borne.
#[cfg(target_os = "linux")]
fn leave_the_desktop() {
    use std::env::{args_os, current_exe, var_os};
    use std::os::unix::process::CommandExt;
    use std::path::Path;
    use std::process::Command;

    let has_desktop = var_os("XDG_RUNTIME_DIR").is_some_and(|folder| Path::new(&folder).is_absolute());
    if has_desktop || var_os(NO_DEVICE_SELECT).is_some() || !darboux_cli::looks_for_adapters(args_os()) {
        return;
    }
    let Ok(program) = current_exe() else { return };
    let mut words = args_os();
    let mut again = Command::new(program);
    again.env(NO_DEVICE_SELECT, "1");
    if let Some(name) = words.next() {
        again.arg0(name);
    }
    let _only_where_it_fails = again.args(words).exec();
}
