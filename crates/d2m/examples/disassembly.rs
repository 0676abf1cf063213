//! An assembly check: in which order can parts that touch be lifted off? `cargo run -p d2m --example disassembly`
use d2m::bvh::departure;
use d2m::glam::DVec3;
use d2m::{ConstantTwist, MeshTree, Moving, QueryError, QueryOptions, Window};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let block = MeshTree::new(d2m::shapes::mesh("box?x=0.5&y=0.5&z=0.5")?);
    let place = |k: i32| ConstantTwist::REST.with_position(DVec3::Y * f64::from(k));
    // May one part leave another one? At once, not through it, and without meeting it again.
    let leaves = |part: i32, other: i32| -> Result<bool, QueryError> {
        let (still, lifted) = (place(other), place(part).with_linear_velocity(DVec3::Y * 4.0));
        let [a, b] = [Moving::new(&block, &still), Moving::new(&block, &lifted)];
        let parting = departure(a, b, Window::UNIT, &QueryOptions::default())?;
        Ok(parting.answer.is_separated() && parting.left.is_some_and(|left| left.hi < 1e-6))
    };
    let (mut parts, mut order) = (vec![0, 1, 2], Vec::new());
    'next: while !parts.is_empty() {
        for (index, &part) in parts.iter().enumerate() {
            let others = parts.iter().filter(|&&other| other != part);
            let answers = others.map(|&other| leaves(part, other)).collect::<Result<Vec<_>, _>>()?;
            if answers.iter().all(|leaves| *leaves) {
                order.push(parts.remove(index));
                continue 'next;
            }
        }
        return Err("the rest is locked".into());
    }
    assert_eq!(order, [2, 1, 0]);
    Ok(())
}

#[test]
fn from_the_top() {
    main().unwrap();
}
