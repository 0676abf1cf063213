//! Is an answer right? By conservative advancement and samples on the judge's own distance.
use super::{BoxTree, Hint, bound_separation, cross, separation};
use crate::trials::Trial;

/// Separation left at `lo`, in tolerances: the documented promise, in a number of the judge's own.
pub(crate) const MOST_LEFT: f64 = 3.3;

/// What a method says about one trial over [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Claim {
    /// No contact in [0, 1].
    Separated,
    /// No contact before `lo`; within `tolerance` somewhere in [lo, hi].
    Contact { lo: f64, hi: f64, tolerance: f64 },
    /// No contact before this time.
    Undecided { clear_until: f64 },
}

impl Claim {
    /// The time before which it says that nothing touches.
    pub(crate) fn free_until(&self) -> f64 {
        match *self {
            Self::Separated => 1.0,
            Self::Contact { lo, .. } => lo,
            Self::Undecided { clear_until } => clear_until.clamp(0.0, 1.0),
        }
    }
}

/// What is wrong with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fault {
    /// The bodies cross at a time that was claimed to be free.
    Missed { at: f64 },
    /// The bodies cross at `lo`.
    Penetrates,
    /// The separation left at `lo` is larger than [`MOST_LEFT`] tolerances.
    Far { separation: f64 },
    /// Not a time in [0, 1], or reversed.
    Nonsense,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Missed { at } => write!(f, "late or missed: the bodies cross at t = {at:?}"),
            Self::Penetrates => write!(f, "the bodies cross at the claimed time"),
            Self::Far { separation } => write!(f, "separation {separation:.3e} at the claimed time"),
            Self::Nonsense => write!(f, "not a time of the window"),
        }
    }
}

/// Judge of one trial: two meshes and their movement.
pub(crate) struct Judge<'a> {
    pub(crate) a: &'a BoxTree,
    pub(crate) b: &'a BoxTree,
    pub(crate) trial: &'a Trial,
}

/// Advancement stops at this separation, in units of the larger radius; from there on samples decide.
const NEAR: f64 = 1e-3;
/// Steps of advancement before samples decide.
const STEPS: usize = 4000;
/// A gap of the bounding spheres that is worth a step of its own.
const FAR: f64 = 0.01;
/// Samples towards the end.
const SAMPLES: i32 = 26;
/// Steps of the walk through what advancement left open.
const WALK: usize = 1000;
/// Pairs of boxes that advancement and walk may visit, about a second each: bodies of millions of triangles may
/// fly along each other closely for long. Samples, more of them, check what is left.
const EFFORT: u64 = 1 << 23;
/// Samples where the effort did not suffice.
const EVEN: i32 = 64;

/// Conservative advancement: the end of the part of [begin, end] over which steps of distance / speed show the bodies
/// apart, to a separation of `near`; `end` when that is all of it.
///
/// While the bounding spheres are apart their gap is the distance that counts. `separation` is judged at one time
/// after the other.
pub(crate) fn advance(
    trial: &Trial,
    radii: [f64; 2],
    [begin, end]: [f64; 2],
    near: f64,
    mut separation: impl FnMut(f64) -> f64,
) -> f64 {
    let speed = trial.bound_speed(radii[0], radii[1]);
    let mut t = begin;
    for _ in 0..STEPS {
        let centers = (trial.b.position - trial.a.position) + (trial.b.velocity - trial.a.velocity) * t;
        let spheres = centers.length() - radii[0] - radii[1];
        let gap = if spheres > FAR { spheres } else { separation(t) };
        if gap <= near {
            break;
        }
        // Short of the whole step, so that rounding of the distance never carries it too far.
        t += gap * (1.0 - 1e-9) / speed;
        if t >= end {
            return end;
        }
    }
    t
}

impl Judge<'_> {
    /// Distance of the surfaces at this time, 0 when they cross.
    pub(crate) fn separation(&self, t: f64) -> f64 {
        let [at_a, at_b] = self.trial.places(t);
        separation(self.a, self.b, &at_a, &at_b, &mut Hint::default())
    }

    /// A lower bound of it, at least half of it, and 0 when they cross.
    fn bound_separation(&self, t: f64, hint: &mut Hint) -> f64 {
        let [at_a, at_b] = self.trial.places(t);
        bound_separation(self.a, self.b, &at_a, &at_b, hint)
    }

    /// The time up to which advancement shows the bodies apart, in the window.
    pub(crate) fn advance(&self, window: [f64; 2], near: f64) -> f64 {
        let mut hint = Hint::default();
        advance(self.trial, [self.a.radius, self.b.radius], window, near, |t| {
            if hint.effort < EFFORT { self.bound_separation(t, &mut hint) } else { 0.0 }
        })
    }

    /// A time in [begin, end) at which the bodies cross, if advancement, a walk and samples find one.
    ///
    /// Advancement proves the first part free. The walk goes on from there by the distance / speed that is left, but
    /// by no less than a small step: a crossing that lasts longer than that step is found. Samples crowd towards the
    /// end with ratio 4, because a late answer is late by little.
    fn crossing_in(&self, [begin, end]: [f64; 2]) -> Option<f64> {
        if end <= begin {
            return None;
        }
        let size = self.a.radius.max(self.b.radius);
        let free = self.advance([begin, end], NEAR * size);
        let cross_at = |&t: &f64| {
            let [at_a, at_b] = self.trial.places(t);
            t < end && cross(self.a, self.b, &at_a, &at_b)
        };
        let crowded = (0..SAMPLES).map(|k| end - (end - free) * 0.25f64.powi(k)).find(cross_at);
        let speed = self.trial.bound_speed(self.a.radius, self.b.radius);
        let least = (NEAR * size).min((end - free) * speed / 32.0);
        let (mut t, mut hint) = (free, Hint::default());
        for _ in 0..WALK {
            if t >= end {
                return crowded;
            }
            if hint.effort > EFFORT {
                break;
            }
            let gap = self.bound_separation(t, &mut hint);
            if gap == 0.0 {
                return Some(t);
            }
            t += gap.max(least) * (1.0 - 1e-9) / speed;
        }
        let mut even = (0..EVEN).map(|k| t + (end - t) * f64::from(k) / f64::from(EVEN));
        crowded.or_else(|| even.find(cross_at))
    }

    /// What is wrong with the claim; `Ok` with the separation at the claimed time otherwise (infinite if none is).
    pub(crate) fn check(&self, claim: &Claim, exact: bool) -> Result<f64, Fault> {
        self.check_after(0.0, claim, exact)
    }

    /// The same when an earlier claim about the same trial, found right, was already free before `known`
    /// (see [`Claim::free_until`]): that part is not searched again.
    pub(crate) fn check_after(&self, known: f64, claim: &Claim, exact: bool) -> Result<f64, Fault> {
        let free_until =
            |end: f64| self.crossing_in([known, end]).map_or(Ok(()), |at| Err(Fault::Missed { at }));
        match *claim {
            Claim::Separated => free_until(1.0).map(|()| f64::INFINITY),
            Claim::Undecided { clear_until } => {
                free_until(clear_until.clamp(0.0, 1.0)).map(|()| f64::INFINITY)
            }
            Claim::Contact { lo, hi, tolerance } => {
                if !(0.0..=1.0).contains(&lo) || hi < lo {
                    return Err(Fault::Nonsense);
                }
                let left = self.separation(lo);
                free_until(lo)?;
                if left == 0.0 && lo > 0.0 {
                    return Err(Fault::Penetrates);
                }
                // At the start of the window a body may be inside the other, however far its surface is.
                if exact && lo > 0.0 && left > MOST_LEFT * tolerance {
                    return Err(Fault::Far { separation: left });
                }
                Ok(left)
            }
        }
    }
}
