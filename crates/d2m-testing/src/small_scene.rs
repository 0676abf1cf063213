//! Random small scenes of two bodies that are hard for contact queries: parallel faces, coplanar sliding, grazing, fast spin,
//! needles, equal motions, contacts at the ends of the window.
use crate::{Draw, Random, Surface};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};

/// Two bodies with their motions over a window. The same seed and index give the same scene.
#[derive(Debug, Clone)]
pub struct SmallScene {
    /// What was drawn, for messages.
    pub name: String,
    /// The surfaces of the bodies.
    pub surfaces: [Surface; 2],
    /// Their motions.
    pub motions: [ConstantTwist; 2],
    /// Whether the bodies are filled solids, and not surfaces only.
    pub filled: bool,
    /// First and last instant.
    pub window: [f64; 2],
}

impl SmallScene {
    /// Scene number `index` of a seed. `is_closed` says whether a surface may bound a solid.
    ///
    /// ```
    /// use d2m_testing::SmallScene;
    /// let scene = SmallScene::draw(1, 2, |surface| surface.name != "soup");
    /// assert_eq!(scene.name, SmallScene::draw(1, 2, |surface| surface.name != "soup").name);
    /// ```
    pub fn draw(seed: u64, index: u64, is_closed: impl Fn(&Surface) -> bool) -> Self {
        let state = seed.wrapping_mul(1_000_003).wrapping_add(index) ^ 0x9e37_79b9_7f4a_7c15;
        let mut scenes = Scenes(Random(state));
        scenes.0.bits();
        let surfaces = [scenes.surface(), scenes.surface()];
        let motions = scenes.motions();
        let closed = surfaces.iter().all(is_closed);
        let filled = closed && scenes.0.below(4) > 0;
        let window = match scenes.0.below(6) {
            0 => [0.25, 0.75],
            1 => [-1.0, 1.0],
            _ => [0.0, 1.0],
        };
        let [a, b] = [surfaces[0].name, surfaces[1].name];
        let kind = if filled { "filled" } else { "surfaces" };
        let name = format!("seed {seed}, scene {index} ({a} and {b}, {}, {kind})", motions.name);
        Self { name, surfaces, motions: motions.of, filled, window }
    }
}

struct Motions {
    name: &'static str,
    of: [ConstantTwist; 2],
}

/// Draws the parts of scenes.
struct Scenes(Random);

impl Scenes {
    /// In \[−1, 1\], a multiple of 1/8.
    fn eighth(&mut self) -> f64 {
        self.0.below(17) as f64 / 8.0 - 1.0
    }

    fn grid_vector(&mut self) -> DVec3 {
        DVec3::new(self.eighth(), self.eighth(), self.eighth())
    }

    fn surface(&mut self) -> Surface {
        let centered = |name, half: DVec3| Surface { name, ..Surface::cuboid(-half, half) };
        match self.0.below(8) {
            0 | 1 => Surface::cube(0.5),
            2 => centered("box", 0.5 * (DVec3::splat(1.125) + self.grid_vector())),
            3 => centered("plate", DVec3::new(1.0, 0.75, 10f64.powi(-(self.0.below(6) as i32)))),
            4 => {
                let thin = 10f64.powi(-(self.0.below(5) as i32) - 1);
                centered("needle", DVec3::new(1.0, thin, thin))
            }
            5 => Surface::tetrahedron([(); 4].map(|()| self.0.vector())),
            6 => {
                let n = 1 + self.0.below(3) as u32;
                Surface::soup((0..3 * n).map(|_| if n == 1 { self.grid_vector() } else { self.0.vector() }))
            }
            _ => {
                let flat = (0..6).map(|_| self.grid_vector().with_z(0.0));
                Surface { name: "flat soup", ..Surface::soup(flat) }
            }
        }
    }

    fn orientation(&mut self) -> DQuat {
        match self.0.below(3) {
            0 => DQuat::IDENTITY,
            1 => {
                let turns = [
                    DQuat::from_xyzw(1.0, 0.0, 0.0, 1.0),
                    DQuat::from_xyzw(0.0, 0.0, 1.0, 1.0),
                    DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0),
                ];
                turns[self.0.below(3) as usize]
            }
            _ => self.0.quaternion(),
        }
    }

    fn motions(&mut self) -> Motions {
        let motion = |random: &mut Self, x: DVec3, v: DVec3, w: DVec3| {
            ConstantTwist::try_new(x, random.orientation(), v, w).expect("finite")
        };
        let far = 1.0 + 2.0 * self.0.signed().abs();
        let side = self.grid_vector() * 0.5;
        let from = DVec3::new(side.x, side.y, far);
        let zero = DVec3::ZERO;
        match self.0.below(9) {
            0 => {
                let speed = [2.0, 8.0, 512.0, 1e5][self.0.below(4) as usize];
                let fall = DVec3::new(0.0, 0.0, -speed);
                Motions {
                    name: "falling",
                    of: [motion(self, from, fall, zero), motion(self, zero, zero, zero)],
                }
            }
            1 => {
                let v = self.0.vector() * 4.0 - from;
                Motions {
                    name: "drifting",
                    of: [motion(self, from, v, zero), motion(self, zero, zero, zero)],
                }
            }
            2 => {
                let (v, w, u) = (self.0.vector() - from, self.0.vector() * 3.0, self.0.vector() * 3.0);
                Motions { name: "tumbling", of: [motion(self, from, v, w), motion(self, zero, zero, u)] }
            }
            3 => {
                let (w, u) = (self.0.vector() * 40.0, self.0.vector() * 40.0);
                Motions {
                    name: "spinning",
                    of: [motion(self, from, -0.5 * from, w), motion(self, zero, zero, u)],
                }
            }
            4 => {
                let slide = DVec3::new(4.0 * self.eighth(), 4.0, 0.0);
                let high = DVec3::new(side.x, -2.0, self.eighth());
                Motions {
                    name: "sliding",
                    of: [motion(self, high, slide, zero), motion(self, zero, zero, zero)],
                }
            }
            5 => {
                let (v, w) = (self.0.vector() * 8.0, self.0.vector() * 3.0);
                let a = ConstantTwist::try_new(from, DQuat::IDENTITY, v, w).expect("finite");
                let b = a.with_position(self.grid_vector() * 0.25);
                Motions { name: "moving alike", of: [a, b] }
            }
            6 => {
                let axis = DVec3::new(0.0, 0.0, 2.0 + 4.0 * self.eighth());
                let beside = DVec3::new(1.0 + 0.25 * self.eighth(), side.y, 0.0);
                Motions {
                    name: "turning beside",
                    of: [motion(self, beside, zero, axis), motion(self, zero, zero, zero)],
                }
            }
            7 => {
                let (w, offset) = (self.0.vector() * 2.0, self.0.vector() * 1e4);
                let (v, u) = (self.0.vector() * 300.0 - from * 300.0, self.0.vector());
                let mut pair = [motion(self, from, v, w), motion(self, zero, zero, u)];
                for m in &mut pair {
                    *m = m.with_position(m.position() + offset);
                }
                Motions { name: "fast and far off", of: pair }
            }
            _ => {
                let (v, w) = (self.0.vector() * 2.0, self.0.vector() * 2.0);
                let near = self.grid_vector() * 0.75;
                Motions { name: "close by", of: [motion(self, near, v, w), motion(self, zero, zero, zero)] }
            }
        }
    }
}
