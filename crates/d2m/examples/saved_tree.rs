//! Prints how many bytes a mesh with its tree takes in a file, and that the tree that is read answers as the first one.
//!
//! `cargo run -p d2m --example saved_tree`

use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, Window, time_of_contact};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let tree = MeshTree::new(d2m::shapes::mesh("torus-knot?triangles=20000")?);
    let path = std::env::temp_dir().join(format!("d2m-saved-tree-{}.d2mtree", std::process::id()));
    std::fs::write(&path, tree.to_bytes())?;

    // Reading checks everything, so a damaged file is an error and never a wrong answer.
    let bytes = std::fs::read(&path)?;
    std::fs::remove_file(&path)?;
    let read = MeshTree::try_from_bytes(&bytes)?;
    println!("{} triangles, {} bytes", read.mesh().triangle_count(), bytes.len());

    let flying: ConstantTwist = "x=-3,0.1,0.2;v=4,0,0;w=0,1,2".parse()?;
    let ask = |body: &MeshTree| {
        let (a, b) = (Moving::new(body, &flying), Moving::new(body, &ConstantTwist::REST));
        time_of_contact(a, b, Window::UNIT, &QueryOptions::default())
    };
    let (before, after) = (ask(&tree)?, ask(&read)?);
    println!("free until {:?} with both", after.contact().map(|contact| contact.time_lo));
    assert!(before.contact().is_some() && before == after, "the same bits");

    let mut damaged = bytes;
    damaged[1000] ^= 1;
    let refused = MeshTree::try_from_bytes(&damaged).err().ok_or("a byte was changed")?;
    println!("with one bit changed: {refused}");
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
