//! `d2m completions` and `d2m man`: the command line as shells and manuals take it.

use crate::arguments::{Arguments, CompletionsArguments, ManArguments};
use crate::failure::Failure;
use crate::output::print;
use clap::CommandFactory;

/// Writes the script of a shell.
pub(crate) fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut bytes = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "d2m", &mut bytes);
    print(&String::from_utf8_lossy(&bytes))
}

/// Writes a manual page.
pub(crate) fn page(arguments: &ManArguments) -> Result<(), Failure> {
    let mut command = Arguments::command();
    command.build();
    let page = match &arguments.command {
        None => command,
        Some(name) => {
            let found = command.find_subcommand(name).cloned();
            let found =
                found.ok_or_else(|| Failure::at("d2m man", format!("there is no subcommand {name:?}")))?;
            let name: &'static str = Box::leak(format!("d2m-{name}").into_boxed_str());
            found.name(name)
        }
    };
    let mut bytes = Vec::new();
    clap_mangen::Man::new(page).render(&mut bytes).map_err(|error| Failure::at("d2m man", error))?;
    print(&String::from_utf8_lossy(&bytes))
}
