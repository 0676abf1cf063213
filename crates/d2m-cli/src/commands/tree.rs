//! `d2m tree`: saves the search tree of a mesh.

use crate::arguments::TreeArguments;
use crate::failure::Failure;
use crate::load::load;
use crate::output::{Output, note};
use crate::report;
use std::path::Path;
use std::time::Instant;

/// Runs the command.
pub(crate) fn run(arguments: &TreeArguments) -> Result<(), Failure> {
    let extension = Path::new(&arguments.out).extension().unwrap_or_default();
    if arguments.out != "-" && !extension.eq_ignore_ascii_case("d2mtree") {
        let reason = "the extension must be .d2mtree, by which a saved tree is known when it is read";
        return Err(Failure::at(format!("--out {}", arguments.out), reason));
    }
    let out = Output::new(&arguments.out)?.spare([Path::new(&arguments.mesh)])?;
    let body = load(&arguments.mesh)?;
    let start = Instant::now();
    let tree = body.into_tree();
    let took = start.elapsed();
    let bytes = tree.to_bytes();
    out.write_bytes(&bytes)?;
    note(&format!(
        "{} triangles, {} bytes; tree built in {}",
        tree.mesh().triangle_count(),
        bytes.len(),
        report::duration(took)
    ));
    Ok(())
}
