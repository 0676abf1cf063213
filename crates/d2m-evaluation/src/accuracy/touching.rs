//! Bodies that touch at the start: are they called so, with the normal along which they part?
//!
//! A cube on an 8 × 8 table at quarter steps, 625 places of each cube on each table: vertices on vertices, on edges and diagonals, edges along
//! edges, faces on faces. Then convex bodies that touch by random features, in frames that are turned, so that no number is exact; pushed
//! in and pulled apart by a millionth of their size as well.
use super::{Outcome, Task};
use crate::bench::Sabotage;
use d2m::bvh::{
    MeshTree, Moving, Posed, QueryOptions, Solid, StartState, TriMesh, Window, distance, time_of_contact,
};
use d2m::motion::{ConstantTwist, Pose};
use d2m_testing::{Draw, KnuthRandom, PlantedTouch, Surface, Touch};
use glam::{DVec3, Vec3Swizzles};

/// Radians that a normal may be off by.
const ANGLE: f64 = 1e-6;
/// Of their size: what bodies are pushed in and pulled apart by.
const DEPTH: f64 = 1e-6;
/// Quarter steps from the middle of the table to either side.
const STEPS: i32 = 12;

/// What is counted of one kind of touch.
#[derive(Default)]
struct Count {
    right: usize,
    wrong: Vec<String>,
}

impl Count {
    fn add(&mut self, fault: Option<String>) {
        match fault {
            Some(fault) => self.wrong.push(fault),
            None => self.right += 1,
        }
    }

    fn conclude(self, what: &str, outcome: &mut Outcome) {
        println!("  {what}: {} right, {} wrong", self.right, self.wrong.len());
        outcome.cases += self.right + self.wrong.len();
        outcome.contacts += self.right + self.wrong.len();
        outcome.false_alarms.extend(self.wrong);
    }
}

/// The family.
pub(super) fn run(task: &Task) -> Outcome {
    let mut outcome = Outcome::default();
    let turned = |normal: DVec3| if task.sabotage == Some(Sabotage::Miss) { normal.yzx() } else { normal };
    for (name, table, solid) in tables() {
        for (cube, low) in [("[0, 1]³", DVec3::ZERO), ("centered", DVec3::splat(-0.5))] {
            let tree = tree(Surface::cuboid(low, low + DVec3::ONE));
            let mut count = Count::default();
            for (i, j) in (-STEPS..=STEPS).flat_map(|i| (-STEPS..=STEPS).map(move |j| (i, j))) {
                let at = DVec3::new(f64::from(i) * 0.25, f64::from(j) * 0.25, -low.z);
                count.add(on_the_table(&table, solid, &tree, at, turned));
            }
            count.conclude(&format!("a {cube} cube on {name}"), &mut outcome);
        }
    }
    let mut random = KnuthRandom(task.seed);
    for touch in Touch::ALL {
        let mut count = Count::default();
        for _ in 0..task.count.div_ceil(Touch::ALL.len()) {
            let Some(planted) = PlantedTouch::draw(&mut random, touch) else { continue };
            count.add(planted_at_rest(&planted, &mut random, turned));
        }
        count.conclude(&format!("{touch:?}, random"), &mut outcome);
    }
    outcome
}

fn tree(surface: Surface) -> MeshTree {
    MeshTree::new(surface.into_mesh(TriMesh::try_new))
}

/// 8 by 8, its upper side at z = 0: a plate, two triangles, 128 of them with corners at whole numbers.
fn tables() -> [(&'static str, MeshTree, Solid); 3] {
    let sheet = |half: i32, step: i32| {
        let corner = |x: i32, y: i32| DVec3::new(f64::from(x), f64::from(y), 0.0);
        let starts = move || (-half..half).step_by(step as usize);
        let cells = starts().flat_map(|x| starts().map(move |y| (x, y)));
        tree(Surface::soup(cells.flat_map(|(x, y)| {
            let [p, q, r, s] =
                [corner(x, y), corner(x + step, y), corner(x + step, y + step), corner(x, y + step)];
            [p, q, r, p, r, s]
        })))
    };
    let plate = tree(Surface::cuboid(DVec3::new(-4.0, -4.0, -1.0), DVec3::new(4.0, 4.0, 0.0)));
    [
        ("a plate", plate, Solid::Filled),
        ("two triangles", sheet(4, 8), Solid::Surface),
        ("128 triangles", sheet(4, 1), Solid::Surface),
    ]
}

/// What is wrong at a place of the cube, if anything.
fn on_the_table(
    table: &MeshTree,
    solid: Solid,
    cube: &MeshTree,
    at: DVec3,
    turned: impl Fn(DVec3) -> DVec3,
) -> Option<String> {
    let place = ConstantTwist::REST.with_position(at);
    let (below, above) =
        (Moving::new(table, &ConstantTwist::REST).with_solid(solid), Moving::new(cube, &place));
    let answer = time_of_contact(below, above, Window::UNIT, &QueryOptions::default()).expect("valid input");
    let right = answer.contact().is_some_and(|contact| {
        contact.start == StartState::Touching && turned(contact.normal).angle_between(DVec3::Z) < ANGLE
    });
    (!right).then(|| format!("the cube at {at}: {answer:?}"))
}

/// What is wrong with a planted touch in a frame that is turned.
fn planted_at_rest(
    planted: &PlantedTouch,
    random: &mut impl Draw,
    turned: impl Fn(DVec3) -> DVec3,
) -> Option<String> {
    let PlantedTouch { bodies, shift, normal, size } = planted;
    let frame = Pose { rotation: random.moderate_turn().normalize(), ..Pose::IDENTITY };
    let [a, b] = bodies.clone().map(tree);
    let at = |depth: f64| {
        let shifted = Pose { translation: frame.rotation * (*shift - *normal * depth), ..frame };
        distance(Posed::new(&a, frame), Posed::new(&b, shifted), Solid::Filled).expect("valid input")
    };
    let touching = at(0.0);
    let wanted = frame.rotation * *normal;
    let is_right =
        touching.state == StartState::Touching && turned(touching.normal).angle_between(wanted) < ANGLE;
    let [deep, high] = [DEPTH, -DEPTH].map(|depth| at(depth * size).state);
    let are_distinguished = deep == StartState::Overlapping && high == StartState::Apart;
    (!(is_right && are_distinguished))
        .then(|| format!("along {wanted}: {touching:?}; deeper {deep:?}, higher {high:?}: {planted:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_normals_pass_and_turned_ones_are_noticed() {
        let task = |sabotage| Task { count: 80, seed: 3, lies: 0, sabotage };
        let right = run(&task(None));
        assert!(right.cases >= 6 * 625 + 40 && right.false_alarms.is_empty(), "{right:?}");
        let broken = run(&task(Some(Sabotage::Miss)));
        assert_eq!(broken.false_alarms.len(), broken.cases);
    }
}
