//! Constants of one query.

use super::base_pose::{Turning, relative_position};
use super::node_test::NodeScale;
use super::queue::{Bucket, Item, Queue};
use super::triangle_pair::PairScale;
use crate::tree::margin::{UNIT_F64, round_up};
use crate::{MeshTree, QueryOptions, Window};
use d2m_motion::ConstantTwist;
use glam::DVec3;

/// Factor of the error of a projected gap of two triangles; see docs/theory/engine.md.
const TRIANGLE_ERROR: f64 = 128.0 * UNIT_F64;
/// Factor of the error of frames, for node tests.
const FRAME_ERROR: f64 = 256.0 * UNIT_F64;
/// Least δ: large against every length whose square is lost to underflow.
pub(crate) const LEAST_TOLERANCE: f64 = 1e-100;
/// Part of δ that pairs are followed to above the level. Large against roundings, small against δ.
const SPARE: f64 = 1.0 / 64.0;
/// Most rotation, both bodies together, inside one window.
const WINDOW_ANGLE: f64 = 0.3;

/// Two bodies, their motions, and the bounds that hold over the whole query.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene<'a> {
    pub(crate) a: (&'a MeshTree, ConstantTwist),
    pub(crate) b: (&'a MeshTree, ConstantTwist),
    pub(crate) window: Window,
    pub(crate) pair: PairScale,
    /// Bound on every length that enters a position.
    pub(crate) size: f64,
    /// δ that is used.
    pub(crate) tolerance: f64,
    /// Longest window of the search.
    pub(crate) longest: f64,
    /// Reach of both bodies from their followed points, together.
    reach: f64,
    /// |ω|·ρ of both bodies, ρ the largest distance from the followed point.
    pub(crate) spin_speed: f64,
    /// How the bodies turn.
    pub(crate) turnings: [Turning; 2],
}

impl<'a> Scene<'a> {
    pub(crate) fn new(
        a: (&'a MeshTree, ConstantTwist),
        b: (&'a MeshTree, ConstantTwist),
        window: Window,
        options: &QueryOptions,
    ) -> Self {
        let reach = |(tree, motion): &(&MeshTree, ConstantTwist)| {
            tree.radius() + (tree.center() - motion.at()).length()
        };
        let (reach_a, reach_b) = (reach(&a), reach(&b));
        let (spin_a, spin_b) = (a.1.angular_velocity().length(), b.1.angular_velocity().length());
        let relative_velocity = a.1.linear_velocity() - b.1.linear_velocity();
        let apart = relative_position(&a.1, &b.1, window.start())
            .length()
            .max(relative_position(&a.1, &b.1, window.end()).length());
        let spin_speed = spin_a * reach_a + spin_b * reach_b;
        let angle = spin_a + spin_b;
        let longest =
            if angle * window.length() > WINDOW_ANGLE { WINDOW_ANGLE / angle } else { window.length() };
        let size = reach_a + reach_b + apart + relative_velocity.length() * longest + spin_speed * longest;
        let error = TRIANGLE_ERROR * size;
        let wanted = options.tolerance.unwrap_or(1e-10 * a.0.radius().max(b.0.radius()));
        let tolerance = wanted.max(2.0 * error).max(LEAST_TOLERANCE);
        let level = options.min_separation + tolerance;
        let acceleration = (spin_a * spin_a * reach_a + spin_b * spin_b * reach_b) * (1.0 + 1e-12);
        let arms = [&a, &b].map(|(tree, motion)| tree.center() - motion.at());
        let swings = [spin_a * spin_a * reach_a, spin_b * spin_b * reach_b].map(|s| s * (1.0 + 1e-12));
        let pair = PairScale {
            level,
            error,
            stop: level + tolerance + error,
            spare: SPARE * tolerance,
            acceleration,
            arms,
            swings,
        };
        let turnings = [Turning::new(&a.1), Turning::new(&b.1)];
        Self { a, b, window, pair, size, tolerance, longest, reach: reach_a + reach_b, spin_speed, turnings }
    }

    /// Axis of the body that spins faster, world; none if neither does.
    pub(crate) fn spin_axis(&self) -> Option<DVec3> {
        let [a, b] = [&self.a, &self.b].map(|body| body.1.angular_velocity());
        let faster = if a.length_squared() >= b.length_squared() { a } else { b };
        faster.try_normalize()
    }

    /// A time, not before `start`, up to which the balls about the followed points (whatever the rotation) stay
    /// further apart than the level.
    pub(crate) fn balls_clear_until(&self, start: f64) -> f64 {
        let apart = relative_position(&self.a.1, &self.b.1, start).length();
        let room = apart - self.reach - self.pair.level - 1e-12 * self.size;
        let speed = (self.a.1.linear_velocity() - self.b.1.linear_velocity()).length();
        let end = self.window.end();
        if room.is_nan() || room <= 0.0 {
            start
        } else if speed * (end - start) < room {
            end
        } else {
            (start + room / speed * (1.0 - 1e-12)).next_down().clamp(start, end)
        }
    }

    /// Constants of the node tests of a window, with the first body's nodes opened, then the second's.
    pub(crate) fn node_scales(&self, time_unit: f64) -> [NodeScale; 2] {
        let spins = [&self.a, &self.b]
            .map(|body| round_up(body.1.angular_velocity().length() * time_unit * (1.0 + 1e-6)));
        let one = |wide: &MeshTree, single: &MeshTree, spin: [f32; 2]| {
            let inverse_unit = 1.0 / wide.unit;
            let speed_scale = time_unit * inverse_unit;
            let acceleration = self.pair.acceleration * time_unit * speed_scale * (1.0 + 1e-6);
            NodeScale {
                ratio: single.unit * inverse_unit,
                inverse_unit,
                speed_scale,
                time_unit,
                spin,
                floor: round_up((self.pair.level * (1.0 + 1e-6) + FRAME_ERROR * self.size) * inverse_unit),
                speed_floor: round_up(FRAME_ERROR * (self.spin_speed + self.size / time_unit) * speed_scale),
                acceleration: round_up(acceleration),
            }
        };
        [one(self.a.0, self.b.0, spins), one(self.b.0, self.a.0, [spins[1], spins[0]])]
    }
}

/// Counts of the work of one search, for profiles: the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SearchCounts {
    /// Windows that were searched.
    pub windows: u64,
    /// Batches handed out by the queue, each with its own frame.
    pub frames: u64,
    /// Wide nodes that were opened against a box.
    pub node_tests: u64,
    /// Pairs of boxes that were queued.
    pub queued: u64,
    /// Looks at pairs of triangles.
    pub triangle_looks: u64,
    /// Attempts to skip time by the sweeps of the bodies.
    pub sweeps: u64,
    /// Pairs of boxes or triangles whose sweeps were compared.
    pub swept_pairs: u64,
}

impl SearchCounts {
    /// All in node tests.
    pub(crate) const fn work(&self) -> u64 {
        self.node_tests + self.triangle_looks + self.swept_pairs
    }

    /// With what `other` adds.
    #[cfg(feature = "rayon")]
    pub(crate) fn with(&self, other: &Self) -> Self {
        self.combined(other, u64::wrapping_add)
    }

    /// Without what was counted by `earlier`.
    #[cfg(feature = "rayon")]
    pub(crate) fn without(&self, earlier: &Self) -> Self {
        self.combined(earlier, u64::wrapping_sub)
    }

    #[cfg(feature = "rayon")]
    fn combined(&self, other: &Self, op: impl Fn(u64, u64) -> u64) -> Self {
        Self {
            windows: op(self.windows, other.windows),
            frames: op(self.frames, other.frames),
            node_tests: op(self.node_tests, other.node_tests),
            queued: op(self.queued, other.queued),
            triangle_looks: op(self.triangle_looks, other.triangle_looks),
            sweeps: op(self.sweeps, other.sweeps),
            swept_pairs: op(self.swept_pairs, other.swept_pairs),
        }
    }
}

/// Memory that one search uses and the next one finds warm.
#[derive(Debug)]
pub(crate) struct Scratch {
    pub(crate) queue: Queue,
    pub(crate) batch: Bucket,
    /// The pairs that a batch leaves.
    pub(crate) fresh: Vec<Item>,
    pub(crate) counts: SearchCounts,
    /// The triangles that were looked at last.
    pub(crate) last_looked_at: [u32; 2],
    /// For windows that are searched ahead by other threads.
    #[cfg(feature = "rayon")]
    pub(crate) helpers: Vec<Scratch>,
}

impl Scratch {
    pub(crate) fn new() -> Self {
        Self {
            queue: Queue::new(),
            batch: Bucket::EMPTY,
            fresh: Vec::new(),
            counts: SearchCounts::default(),
            last_looked_at: [0, 0],
            #[cfg(feature = "rayon")]
            helpers: Vec::new(),
        }
    }
}
