//! Hard scenes: bodies that stay close for long, or turn fast, with answers known by construction.

use d2m::bvh::{Answered, time_of_contact_counted};
use d2m::glam::{DQuat, DVec3};
use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, Solid, TimeOfContact, Window};
use std::f64::consts::PI;

/// What the construction of a scene says about its answer over [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// The bodies never come closer than this.
    Clear {
        /// A distance.
        clearance: f64,
    },
    /// They first touch in this span of time.
    Contact {
        /// Not before.
        from: f64,
        /// Not after.
        to: f64,
    },
}

/// Two bodies with their motions over [0, 1].
#[derive(Debug)]
pub struct HardScene {
    /// What it shows.
    pub name: String,
    /// The meshes with their trees.
    pub bodies: [MeshTree; 2],
    /// Their motions.
    pub motions: [ConstantTwist; 2],
    /// The answer by construction.
    pub expected: Expected,
}

impl HardScene {
    /// Asks the default engine with its default tolerance.
    ///
    /// # Panics
    /// Never: the scenes are valid.
    pub fn ask(&self) -> TimeOfContact {
        self.ask_with(&QueryOptions::default().with_solid(Solid::Surface))
    }

    /// Asks the default engine.
    ///
    /// # Panics
    /// If the options are not valid.
    pub fn ask_with(&self, options: &QueryOptions) -> TimeOfContact {
        self.ask_counted(options).answer
    }

    /// Asks the default engine what it answers and what it does for that.
    ///
    /// # Panics
    /// If the options are not valid.
    pub fn ask_counted(&self, options: &QueryOptions) -> Answered<TimeOfContact> {
        let [a, b] = [0, 1].map(|k| Moving::new(&self.bodies[k], &self.motions[k]));
        time_of_contact_counted(a, b, Window::UNIT, options).expect("valid input")
    }

    /// What is wrong with an answer: `None` if it agrees with the construction.
    pub fn fault(&self, answer: &TimeOfContact) -> Option<String> {
        match (*answer, self.expected) {
            (TimeOfContact::Separated, Expected::Clear { .. }) => None,
            (TimeOfContact::Contact(contact), Expected::Contact { from, to }) => {
                // Within the tolerance before the touch is right.
                let early = 1e-7;
                (contact.time_lo < from - early || contact.time_lo > to)
                    .then(|| format!("{}: at {} instead of {from}..{to}", self.name, contact.time_lo))
            }
            (answer, expected) => Some(format!("{}: {answer:?} instead of {expected:?}", self.name)),
        }
    }
}

fn tree(text: &str) -> MeshTree {
    MeshTree::new(d2m::shapes::mesh(text).expect("a shape of the project"))
}

fn still() -> ConstantTwist {
    ConstantTwist::REST
}

/// A cube spins at |ω| = 300 about the cube's diagonal (−1, 1, 0) while its farthest corners, at distance 1, pass a
/// face at `gap`; `drift`: speed along the face.
///
/// # Panics
/// If a number is not finite.
pub fn grazing_cube(triangles: usize, gap: f64, drift: f64) -> HardScene {
    let cube = tree(&format!("box?triangles={triangles}"));
    let wall = tree(&format!("box?triangles={triangles}&x=1&y=1&z=1"));
    let turn = DQuat::from_rotation_arc(DVec3::new(-1.0, 1.0, 0.0).normalize(), DVec3::Z);
    let spin =
        ConstantTwist::try_new(DVec3::new(0.0, -0.5 * drift, 0.0), turn, DVec3::Y * drift, DVec3::Z * 300.0)
            .expect("finite");
    // A corner reaches 1 in each half turn.
    let expected = if gap > 0.0 {
        Expected::Clear { clearance: gap * (1.0 - 1e-9) }
    } else {
        Expected::Contact { from: 0.0, to: PI / 300.0 }
    };
    HardScene {
        name: format!("cube at |w| = 300, {triangles} triangles, gap {gap:e}, drift {drift}"),
        bodies: [cube, wall],
        motions: [spin, still().with_position(DVec3::X * (2.0 + gap))],
        expected,
    }
}

/// A box slides on another one at height `gap`, turning by `turn` about the normal.
pub fn sliding_box(triangles: usize, gap: f64, turn: f64) -> HardScene {
    let upper = tree(&format!("box?triangles={triangles}&x=0.5&y=0.5&z=0.5"));
    let lower = tree(&format!("box?triangles={triangles}&x=1&y=1&z=0.5"));
    let slide = still()
        .with_position(DVec3::new(-0.5, -0.2, 1.0 + gap))
        .with_linear_velocity(DVec3::new(1.0, 0.3, 0.0))
        .with_angular_velocity(DVec3::Z * turn);
    let expected = if gap > 0.0 {
        Expected::Clear { clearance: 0.999 * gap }
    } else {
        Expected::Contact { from: 0.0, to: 1e-9 }
    };
    HardScene {
        name: format!("sliding at {gap:e}, {triangles} triangles, turn {turn}"),
        bodies: [upper, lower],
        motions: [slide, still()],
        expected,
    }
}

/// A shaft turns once in its bearing; `drift`: speed away from the common axis; `both`: the bearing turns too.
pub fn shaft_in_bearing(triangles: usize, clearance: f64, drift: f64, both: bool) -> HardScene {
    let shaft = tree(&format!("shaft?triangles={triangles}"));
    let bearing = tree(&format!("bearing?triangles={triangles}&clearance={clearance}"));
    let turn = still().with_angular_velocity(DVec3::Z * (2.0 * PI)).with_linear_velocity(DVec3::X * drift);
    let other = if both { still().with_angular_velocity(DVec3::Z * -1.5) } else { still() };
    let expected = if drift <= clearance {
        Expected::Clear { clearance: clearance - drift }
    } else {
        Expected::Contact { from: clearance / drift, to: 1.0 }
    };
    HardScene {
        name: format!(
            "shaft in bearing, clearance {clearance:e}, {triangles} x2, drift {drift:e}, both turn {both}"
        ),
        bodies: [shaft, bearing],
        motions: [turn, other],
        expected,
    }
}

/// Length unit of `screw` and `nut` with so many turns: before scaling their pitch is 0.2, half of the thread 0.1 a turn,
/// the head 0.25 high and its radius 0.6.
fn screw_unit(turns: u32) -> f64 {
    let bottom = 0.1 * f64::from(turns) + 0.25;
    1.0 / (bottom * bottom + 0.36).sqrt()
}

/// A screw turns in its nut, in the middle of its thread of six turns at the start; `drift`: speed across the axis.
pub fn screw_in_nut(triangles: usize, clearance: f64, turns: f64, drift: f64) -> HardScene {
    let screw = tree(&format!("screw?triangles={triangles}"));
    let nut = tree(&format!("nut?triangles={triangles}&clearance={clearance}"));
    let unit = screw_unit(6);
    let motion = still()
        .with_angular_velocity(DVec3::Z * (2.0 * PI * turns))
        .with_linear_velocity(DVec3::new(drift, 0.0, 0.2 * unit * turns));
    // After two turns the head is at the nut.
    let expected = if drift > 0.0 {
        Expected::Contact { from: 0.0, to: 1.0 }
    } else if turns > 2.0 {
        Expected::Contact { from: 2.0 / turns, to: 2.0 / turns }
    } else {
        Expected::Clear { clearance: 0.6 * clearance * unit }
    };
    HardScene {
        name: format!(
            "screw in nut, clearance {clearance:e}, {turns} turns, {triangles} x2, drift {drift:e}"
        ),
        bodies: [screw, nut],
        motions: [motion, still()],
        expected,
    }
}

/// A screw with a thread of 16 turns goes through its nut by ten of them: five on either side of the middle. It has as
/// many columns as the one of six turns, so more triangles.
pub fn long_screw_in_nut(triangles: usize, clearance: f64) -> HardScene {
    let screw = tree(&format!("screw?triangles={}&turns=16", triangles * 8 / 3));
    let nut = tree(&format!("nut?triangles={triangles}&turns=16&clearance={clearance}"));
    let unit = screw_unit(16);
    let motion = still()
        .with_position(DVec3::Z * (-5.0 * 0.2 * unit))
        .with_angular_velocity(DVec3::Z * (20.0 * PI))
        .with_linear_velocity(DVec3::Z * (10.0 * 0.2 * unit));
    HardScene {
        name: format!("long screw in nut, clearance {clearance:e}, 10 turns, {triangles} x2"),
        bodies: [screw, nut],
        motions: [motion, still()],
        expected: Expected::Clear { clearance: 0.6 * clearance * unit },
    }
}

/// Two interlocked rings; the second turns about its own axis. `drift` > 0.7: it meets the first.
///
/// # Panics
/// If a number is not finite.
pub fn interlocked_rings(triangles: usize, drift: f64) -> HardScene {
    let ring = tree(&format!("torus?triangles={triangles}&tube=0.2"));
    // Radius of the middle line 0.8: the second's passes through the center of the first.
    let second = ConstantTwist::try_new(
        DVec3::X * 0.8,
        DQuat::from_rotation_x(0.5 * PI),
        DVec3::X * drift,
        DVec3::new(0.0, 5.0, 0.0),
    )
    .expect("finite");
    // Tube against tube: 0.8 − 2·0.2 apart at the start, closing by the drift; coarse tubes are thinner.
    let expected = if drift == 0.0 {
        Expected::Clear { clearance: 0.39 }
    } else {
        Expected::Contact { from: 0.39 / drift, to: 0.7 / drift }
    };
    HardScene {
        name: format!("interlocked rings, {triangles} x2, drift {drift}"),
        bodies: [ring.clone(), ring],
        motions: [still(), second],
        expected,
    }
}

/// Two bars of length 2, axes of spin 1.45 apart, intermesh like the blades of a whisk: both turn at `spin` in the same sense,
/// always at right angles. `phase`: B lags behind by so much; from 0.1 on they hit each other.
///
/// # Panics
/// If a number is not finite.
pub fn intermeshing_bars(triangles: usize, spin: f64, phase: f64) -> HardScene {
    let bar = tree(&format!("box?triangles={triangles}&x=1&y=0.02&z=0.02"));
    let turn = |angle: f64, x: f64| {
        ConstantTwist::try_new(DVec3::X * x, DQuat::from_rotation_z(angle), DVec3::ZERO, DVec3::Z * spin)
            .expect("finite")
    };
    // Seen with A along x, B's middle is at 1.45 (cos θ, −sin θ): the ends are nearest at 45°, 1.45/√2 − 1 apart both ways.
    let gap = 2f64.sqrt() * (1.45 / 2f64.sqrt() - 1.02);
    let expected = if phase == 0.0 {
        Expected::Clear { clearance: gap * (1.0 - 1e-9) }
    } else {
        Expected::Contact { from: 0.0, to: PI / spin }
    };
    HardScene {
        name: format!("intermeshing bars at |w| = {spin}, {triangles} x2, phase {phase}"),
        bodies: [bar.clone(), bar],
        motions: [turn(0.0, 0.0), turn(0.5 * PI - phase, 1.45)],
        expected,
    }
}

/// Two needles of an aspect ratio cross at right angles and pass each other at `gap` (negative: they meet).
///
/// # Panics
/// If a number is not finite.
pub fn needles(aspect: f64, gap: f64, spin: f64) -> HardScene {
    let needle = tree(&format!("needle?triangles=16&aspect={aspect}"));
    let thick = 1.0 / aspect;
    let coming = ConstantTwist::try_new(
        DVec3::new(-1.0, 2.0 * thick + gap, 0.0),
        DQuat::from_rotation_x(0.5 * PI),
        DVec3::X * 2.0,
        DVec3::Y * spin,
    )
    .expect("finite");
    // B along z through the origin; A along y, so its middle passes B's: the sum of the half thicknesses decides.
    let lying = coming.with_position(DVec3::new(-1.0, 0.0, 0.0));
    let (motion, expected) = if gap > 0.0 {
        let beside = lying.with_position(DVec3::new(-1.0, 1.0 + thick + gap, 0.0));
        (beside, Expected::Clear { clearance: 0.5 * gap })
    } else {
        (lying, Expected::Contact { from: 0.5 - 2.0 * thick, to: 0.5 })
    };
    HardScene {
        name: format!("needles of aspect {aspect:e}, gap {gap:e}, spin {spin}"),
        bodies: [needle.clone(), needle],
        motions: [motion, still()],
        expected,
    }
}

/// The table at a size: 1 is full size, 0.02 is for tests.
pub fn table(size: f64) -> Vec<HardScene> {
    let count = |full: usize| (full as f64 * size) as usize;
    vec![
        grazing_cube(12, 1e-4, 0.0),
        grazing_cube(12, 1e-4, 0.8),
        grazing_cube(count(4800).max(12), 1e-4, 0.0),
        grazing_cube(count(4800).max(12), 1e-4, 0.8),
        grazing_cube(count(4800).max(12), -1e-4, 0.0),
        sliding_box(count(4800).max(12), 1e-9, 0.0),
        sliding_box(count(4800).max(12), 1e-9, 1.0),
        sliding_box(count(4800).max(12), 1e-9, 3.0),
        shaft_in_bearing(count(2560).max(64), 1e-2, 0.0, false),
        shaft_in_bearing(count(2560).max(64), 1e-6, 0.0, false),
        shaft_in_bearing(count(2560).max(64), 1e-2, 0.0, true),
        shaft_in_bearing(count(2560).max(64), 1e-2, 0.015, false),
        screw_in_nut(count(15_360).max(2000), 3e-2, 0.5, 0.0),
        screw_in_nut(count(15_360).max(2000), 1e-2, 0.5, 0.0),
        screw_in_nut(count(15_360).max(2000), 1e-4, 0.5, 0.0),
        screw_in_nut(count(15_360).max(2000), 1e-4, 10.0, 0.0),
        long_screw_in_nut(count(15_360).max(2000), 1e-4),
        screw_in_nut(count(15_360).max(2000), 1e-2, 0.5, 0.1),
        interlocked_rings(count(3200).max(64), 0.0),
        interlocked_rings(count(3200).max(64), 0.8),
        intermeshing_bars(count(4800).max(12), 300.0, 0.0),
        intermeshing_bars(count(4800).max(12), 300.0, 0.2),
        needles(1e6, 1e-9, 3.0),
        needles(1e6, -1e-9, 0.0),
    ]
}
