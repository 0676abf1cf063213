//! Bodies at rest whose surfaces meet: do they touch, or do their insides overlap?
//!
//! **Touching** is proven by parting: a unit direction n and a length h of a few roundings, such that B, moved by h·n, is proven apart from A.
//! So insides share no more than a layer of that thickness. Where poses only shift the bodies, numbers are exact, and more is proven, by exact
//! signs: every two triangles that come within h of each other have a plane with normal m between them (none of A's vertices above any of
//! B's, along m) from which n rises, m·n > 0. Then no two triangles share a point while B moves along n, at any length in (0, h], and at h
//! the bodies are apart; since insides are open, insides that overlapped at the start would still overlap a little later, while surfaces
//! are apart, and bodies whose surfaces stay apart do not leave each other's inside. So the insides are disjoint.
//!
//! **Overlapping** is proven by a pair of triangles that share a point wherever their vertices are within the errors of placing them, or, with
//! exact numbers, by two triangles with no plane between them: their relative interiors cross, and at that point both bodies have insides on
//! both sides. Or, where surfaces meet in faces and edges only, by a point that is proven to be inside of both.
//!
//! Neither proven: undecided. docs/theory/questions.md has the lemmas.

mod axis;
mod exact;
pub(crate) mod inside;
mod parting;

use super::collide::{near_pairs, proven_crossing_pair, surfaces_are_apart};
use super::containment::{Held, held_by, one_holds_the_other};
use super::node_pair::RestingScene;
use crate::meter::{Exhausted, Meter};
use crate::{Posed, QueryError, Solid, StartState};
use axis::{Axis, Sides, TouchingPair};
use core::cmp::Ordering;
use d2m_lanes::power_of_two;
use exact::ExactPlaces;
use glam::DVec3;
use parting::{Directions, LEAST_RISE, directions, mixtures, steepest_rise};

/// Pairs of triangles that a direction is chosen by, and that exact signs are evaluated of.
const MOST_PAIRS: usize = 1 << 11;
/// Roundings of the placed triangles that are judged, of the size of the scene: 2⁻²⁶, far above those of any numbers.
const MOST_ROUNDING: f64 = power_of_two(-26);
/// How far B is moved to part, in roundings of the placed triangles over the least rise, first and at most.
const FIRST_STEP: f64 = 4.0;
const LAST_STEP: f64 = 512.0;
const LONGER: f64 = 4.0;
/// Axes of any pair that are tried for every pair, the nearest ones to a direction.
const NEAREST: usize = 16;
/// Directions nearer than this to an axis of a pair are its normal: 2⁻⁴⁰, an angle.
const ALONG: f64 = power_of_two(-40);

/// Which pairs of triangles are known of those that are near enough to meet before the bodies have parted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Near {
    All,
    /// They are too many, or one of them stands for all of a body.
    Some,
}

/// How two bodies meet whose surfaces are not proven apart.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::at_rest::{Meeters, Meeting};
/// use d2m_mesh::{Meter, Posed, Solid, StartState};
/// use d2m_motion::Pose;
/// // One stands half as high as the other: they overlap.
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 0.5, ..Pose::IDENTITY });
/// let bodies = [Posed::at_rest(&tree), above];
/// let meeters = Meeters { bodies, solids: [Solid::Filled; 2], blur: 0.0, patience: 1000 };
/// let meeting = meeters.meeting(&mut Meter::unlimited())?.expect("they are not apart");
/// assert!(matches!(meeting, Meeting::Overlapping(_)) && meeting.state() == StartState::Overlapping);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Meeting<'a> {
    /// They part.
    Touching(Touch<'a>),
    /// Proven: their insides share a point, or their surfaces cross. With a pair of triangles that cross, if that is the proof.
    Overlapping(Option<[u32; 2]>),
    /// Proven: their surfaces are apart, and one that is filled holds a part of the other.
    Holding(Held),
    /// None of these is proven.
    Undecided,
}

impl Meeting<'_> {
    /// The same of B and A.
    fn exchanged(self) -> Self {
        match self {
            Self::Touching(Touch { normal, triangles: [a, b], moved: [of_a, of_b], parted_by }) => {
                Self::Touching(Touch { normal: -normal, triangles: [b, a], moved: [of_b, of_a], parted_by })
            }
            Self::Overlapping(triangles) => Self::Overlapping(triangles.map(|[a, b]| [b, a])),
            Self::Holding(held) => Self::Holding(Held { by: 1 - held.by, ..held }),
            Self::Undecided => Self::Undecided,
        }
    }

    /// In the words of an answer.
    pub const fn state(&self) -> StartState {
        match self {
            Self::Touching(_) => StartState::Touching,
            Self::Overlapping(_) => StartState::Overlapping,
            Self::Holding(_) => StartState::Contained,
            Self::Undecided => StartState::Undecided,
        }
    }
}

/// Bodies that touch.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::at_rest::{Meeters, Meeting};
/// use d2m_mesh::{Meter, Posed, Solid};
/// use d2m_motion::Pose;
/// // One stands on the tip of the other.
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z, ..Pose::IDENTITY });
/// let bodies = [Posed::at_rest(&tree), above];
/// let meeters = Meeters { bodies, solids: [Solid::Filled; 2], blur: 0.0, patience: 1000 };
/// let Some(Meeting::Touching(touch)) = meeters.meeting(&mut Meter::unlimited())? else { panic!("they touch") };
/// assert!(touch.normal.z > 0.5 && touch.parted_by < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Touch<'a> {
    /// Unit direction from A to B, world frame: B moved along it parts from A.
    pub normal: DVec3,
    /// Triangles that touch, with that normal if there are such.
    pub triangles: [u32; 2],
    /// Proven apart: the same bodies, one moved away from the other along the normal.
    pub moved: [Posed<'a>; 2],
    /// How far it was moved, to rounding.
    pub parted_by: f64,
}

/// Two bodies at rest, and what they are: see [`Meeting`].
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// use d2m_mesh::at_rest::Meeters;
/// use d2m_mesh::{Meter, Posed, Solid};
/// use d2m_motion::Pose;
/// let point = MeshTree::new(TriMesh::point(DVec3::ZERO)?);
/// let bodies = [Posed::at_rest(&point), Posed::new(&point, Pose { translation: DVec3::X, ..Pose::IDENTITY })];
/// let meeters = Meeters { bodies, solids: [Solid::Surface; 2], blur: 0.0, patience: 1000 };
/// assert!(meeters.meeting(&mut Meter::unlimited())?.is_none()); // proven apart
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Meeters<'a> {
    /// A and B.
    pub bodies: [Posed<'a>; 2],
    /// What belongs to each.
    pub solids: [Solid; 2],
    /// How far vertices of both bodies together may be from where the poses place them: zero for poses as given.
    pub blur: f64,
    /// Node tests and comparisons of each part of the decision.
    pub patience: u64,
}

impl<'a> Meeters<'a> {
    /// How they meet, whichever of them is named first. `None`: their surfaces are proven apart by more than this can judge, and none holds the other.
    ///
    /// # Errors
    /// [`QueryError::BadPose`].
    pub fn meeting(&self, meter: &mut Meter) -> Result<Option<Meeting<'a>>, QueryError> {
        let [key, other] = self.bodies.map(order);
        let is_exchanged = key.iter().zip(&other).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne())
            == Some(Ordering::Greater);
        let [first, second] =
            if is_exchanged { [self.exchanged(), *self] } else { [*self, self.exchanged()] };
        let (mut found, mut is_of_second) = (first.meeting_in_order(meter)?, false);
        if matches!(found, Some(Meeting::Undecided)) {
            // Directions and points are tried in the second body's frame: in the other one they may be found.
            (found, is_of_second) = (second.meeting_in_order(meter)?, true);
        }
        Ok(if is_of_second == is_exchanged { found } else { found.map(Meeting::exchanged) })
    }

    /// B and A.
    fn exchanged(&self) -> Self {
        let ([a, b], [of_a, of_b]) = (self.bodies, self.solids);
        Self { bodies: [b, a], solids: [of_b, of_a], ..*self }
    }

    fn meeting_in_order(&self, meter: &mut Meter) -> Result<Option<Meeting<'a>>, QueryError> {
        let [a, b] = self.bodies;
        let scene = RestingScene::try_blurred(a, b, self.blur)?;
        // In units so small that underflow takes a part of all lengths nothing is proven, nor of vertices that may be anywhere.
        if scene.need.is_nan() || scene.need > MOST_ROUNDING {
            return Ok(Some(Meeting::Undecided));
        }
        Ok(self.decide(&scene, meter).unwrap_or(Some(Meeting::Undecided)))
    }

    /// A part of the decision. `None`: it takes more than the patience.
    ///
    /// # Errors
    /// [`Exhausted`]: nothing is left at all.
    fn within<T>(
        &self,
        meter: &mut Meter,
        part: impl FnOnce(&mut Meter) -> Result<T, Exhausted>,
    ) -> Result<Option<T>, Exhausted> {
        let mut some = meter.at_most(self.patience);
        let found = part(&mut some);
        meter.spend(some.spent());
        match found {
            Ok(found) => Ok(Some(found)),
            Err(Exhausted) if meter.is_exhausted() => Err(Exhausted),
            Err(Exhausted) => Ok(None),
        }
    }

    fn decide(&self, scene: &RestingScene<'_>, meter: &mut Meter) -> Result<Option<Meeting<'a>>, Exhausted> {
        let crossing = self.within(meter, |some| proven_crossing_pair(scene, some))?;
        if let Some(triangles) = crossing.flatten() {
            return Ok(Some(Meeting::Overlapping(Some(triangles))));
        }
        let [a, b] = self.bodies;
        let Ok(wide) = RestingScene::try_blurred(a, b, self.blur) else {
            return Ok(Some(Meeting::Undecided));
        };
        let wide = wide.reaching(LAST_STEP * scene.need);
        let mut near = Vec::new();
        let finished = self.within(meter, |some| near_pairs(&wide, MOST_PAIRS, some, &mut near))?.is_some();
        // Surfaces that are apart, by however little: what one of the bodies holds it holds with any rounding.
        let are_apart = if near.is_empty() {
            finished
        } else {
            self.within(meter, |some| surfaces_are_apart(scene, some))? == Some(true)
        };
        let holding = |some: &mut Meter| one_holds_the_other(scene, self.solids, some);
        let held = if are_apart { self.within(meter, holding)? } else { None };
        match held {
            Some(Some(held)) => return Ok(Some(Meeting::Holding(held))),
            _ if !near.is_empty() => {}
            Some(None) => return Ok(None),
            None => return Ok(Some(Meeting::Undecided)),
        }
        // A body that is a point to rounding is stood for by its first triangle.
        let is_known = finished && near.len() < MOST_PAIRS && ![0, 1].iter().any(|&k| wide.is_point_like(k));
        let known = if is_known { Near::All } else { Near::Some };
        let exact = if self.blur > 0.0 { None } else { ExactPlaces::try_new(self.bodies) };
        let oriented = [0, 1].map(|k| self.solids[k] == Solid::Filled && scene.trees[k].oriented);
        let pairs = |sides: Sides, meter: &mut Meter| -> Result<Vec<TouchingPair>, Exhausted> {
            let of = |pair: &[u32; 2]| {
                meter.read_clock()?;
                Ok(TouchingPair::new(scene, *pair, scene.need, sides))
            };
            near.iter().map(of).collect()
        };
        let outward = pairs(Sides::Outward(oriented), meter)?;
        for pair in exact.iter().flat_map(|_| &outward) {
            meter.read_clock()?;
            if exact.as_ref().is_some_and(|exact| exact.cross(pair)) {
                return Ok(Some(Meeting::Overlapping(Some(pair.triangles))));
            }
        }
        if let Some(touch) = self.parted(scene, (&outward, known), exact.as_ref(), meter)? {
            return Ok(Some(Meeting::Touching(touch)));
        }
        // Solids that are inside out part where their faces say the opposite.
        let any = pairs(Sides::Any, meter)?;
        if oriented != [false; 2]
            && let Some(touch) = self.parted(scene, (&any, known), exact.as_ref(), meter)?
        {
            return Ok(Some(Meeting::Touching(touch)));
        }
        let filled = self.solids == [Solid::Filled; 2];
        if filled {
            let shared =
                |some: &mut Meter| inside::share_a_point_inside((self.bodies, self.blur), scene, &any, some);
            if self.within(meter, shared)? == Some(true) {
                return Ok(Some(Meeting::Overlapping(None)));
            }
        }
        Ok(Some(Meeting::Undecided))
    }

    /// The direction along which B is proven to part, if one is found.
    fn parted(
        &self,
        scene: &RestingScene<'_>,
        (pairs, known): (&[TouchingPair], Near),
        exact: Option<&ExactPlaces<'_>>,
        meter: &mut Meter,
    ) -> Result<Option<Touch<'a>>, Exhausted> {
        let Directions { found, several } = directions(pairs, scene.need, meter)?;
        let touch = self.parted_along(&found, scene, (pairs, known), exact, meter)?;
        // Sought only where the others were not enough.
        if touch.is_some() || !several {
            return Ok(touch);
        }
        let mixed = mixtures(pairs, meter)?;
        self.parted_along(&mixed, scene, (pairs, known), exact, meter)
    }

    /// The first of some directions along which B is proven to part.
    fn parted_along(
        &self,
        tried: &[DVec3],
        scene: &RestingScene<'_>,
        (pairs, known): (&[TouchingPair], Near),
        exact: Option<&ExactPlaces<'_>>,
        meter: &mut Meter,
    ) -> Result<Option<Touch<'a>>, Exhausted> {
        for &n in tried {
            meter.read_clock()?;
            let rise = pairs.iter().map(|pair| steepest_rise(pair, n)).fold(1.0, f64::min);
            // What is not a number rises nowhere.
            if rise.is_nan() || rise <= LEAST_RISE {
                continue;
            }
            if let Some(exact) = exact {
                let nearest = nearest_axes(pairs, n);
                let is_parted = match known {
                    Near::All => all(pairs, meter, |pair| exact.part_along(pair, &nearest, n, rise))?,
                    Near::Some => self.may_sign_all(meter) && exact.are_bodies_parted(&nearest, n, rise),
                };
                if !is_parted {
                    continue;
                }
            }
            let normal = (self.bodies[1].pose.rotation.normalize() * n).normalize_or_zero();
            let mut step = FIRST_STEP / rise;
            while step <= LAST_STEP {
                let parted_by = step * scene.need * scene.unit;
                if let Some(moved) = self.moved(normal * parted_by, 0.25 * rise)
                    && self.are_apart(moved, n, meter)?
                {
                    let triangles = representative(pairs, n);
                    return Ok(Some(Touch { normal, triangles, moved, parted_by }));
                }
                step *= LONGER;
            }
        }
        Ok(None)
    }

    /// Is the patience enough for the exact sign of each vertex? Then it is spent.
    fn may_sign_all(&self, meter: &mut Meter) -> bool {
        let vertices: usize = self.bodies.iter().map(|posed| posed.body.mesh().vertex_count()).sum();
        let is_enough = vertices as u64 <= self.patience && !meter.is_exhausted();
        if is_enough {
            meter.spend(vertices as u64);
        }
        is_enough
    }

    /// B moved away from A, or A the other way: the number is changed that rounds the least. `None`: it rounds by more than this part.
    fn moved(&self, by: DVec3, most: f64) -> Option<[Posed<'a>; 2]> {
        let size = |v: DVec3| v.abs().max_element();
        let sizes = self.bodies.map(|posed| [size(posed.pose.translation), size(posed.pose.at)]);
        let (body, place) = [(1, 0), (1, 1), (0, 0), (0, 1)]
            .into_iter()
            .min_by(|&(i, j), &(k, l): &(usize, usize)| sizes[i][j].total_cmp(&sizes[k][l]))?;
        let away = if body == 1 { by } else { -by };
        let mut bodies = self.bodies;
        let pose = &mut bodies[body].pose;
        let (number, change) = if place == 0 {
            (&mut pose.translation, away)
        } else {
            (&mut pose.at, -(pose.rotation.normalize().inverse() * away))
        };
        let before = *number;
        *number += change;
        // The difference of two numbers so near to each other is exact, or the change is much larger than the numbers.
        (((*number - before) - change).length() <= most * change.length()).then_some(bodies)
    }

    /// Are two bodies proven apart, by the boxes of their trees, or by a plane across a direction of B's axes?
    fn are_apart(&self, [a, b]: [Posed<'_>; 2], n: DVec3, meter: &mut Meter) -> Result<bool, Exhausted> {
        let Ok(scene) = RestingScene::try_blurred(a, b, self.blur) else { return Ok(false) };
        match self.within(meter, |some| surfaces_are_apart(&scene, some))? {
            Some(false) => return Ok(false),
            // Thousands of pairs that touch, at one vertex, say: bodies on two sides of a plane hold nothing of each other, either.
            None => return Ok(is_a_plane_between(&scene, n)),
            Some(true) => {}
        }
        for by in [0, 1] {
            if self.solids[by] == Solid::Filled && held_by(&scene, by, meter)?.is_some() {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// Is that so of all pairs?
///
/// # Errors
/// [`Exhausted`]: the time is over.
fn all(
    pairs: &[TouchingPair],
    meter: &mut Meter,
    holds: impl Fn(&TouchingPair) -> bool,
) -> Result<bool, Exhausted> {
    for pair in pairs {
        meter.read_clock()?;
        if !holds(pair) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// What bodies are put into an order by, so that it does not depend on how they are named.
fn order(posed: Posed<'_>) -> [f64; 12] {
    let (mesh, pose) = (posed.body.mesh(), posed.pose);
    let [x, y, z] = pose.translation.to_array();
    let [i, j, k, w] = pose.rotation.to_array();
    let [u, v, t] = posed.body.center().to_array();
    let counts = [mesh.triangle_count(), mesh.vertex_count()].map(|n| n as f64);
    [counts[0], counts[1], x, y, z, i, j, k, w, u, v, t]
}

/// Is all of B proven further along a unit direction than all of A?
fn is_a_plane_between(scene: &RestingScene<'_>, n: DVec3) -> bool {
    let along = |body: usize| {
        let corners = scene.trees[body].mesh().triangles().as_flattened();
        corners.iter().map(move |&vertex| n.dot(scene.place_vertex(body, vertex)))
    };
    let high = along(0).fold(f64::NEG_INFINITY, larger);
    let low = along(1).fold(f64::INFINITY, |x, y| if y < x || y.is_nan() { y } else { x });
    // Both bodies' errors and the rounding of a projected gap; the direction is a unit to rounding, of which there is room.
    low - high > scene.need
}

/// What is not a number is larger than any.
fn larger(x: f64, y: f64) -> f64 {
    if y > x || y.is_nan() { y } else { x }
}

/// The axes of the pairs that are nearest to a direction.
fn nearest_axes(pairs: &[TouchingPair], n: DVec3) -> Vec<Axis> {
    let mut axes: Vec<Axis> = pairs.iter().flat_map(|pair| &pair.axes).copied().collect();
    axes.sort_by(|x, y| (x.direction - n).length().total_cmp(&(y.direction - n).length()));
    axes.truncate(NEAREST);
    axes
}

/// A pair that touches with this normal; of several one that has few others, so that its features are those that touch.
fn representative(pairs: &[TouchingPair], n: DVec3) -> [u32; 2] {
    let along = |pair: &&TouchingPair| pair.axes.iter().any(|axis| (axis.direction - n).length() <= ALONG);
    let overlap = |pair: &TouchingPair| pair.overlap(n);
    let best = pairs.iter().filter(along).max_by(|x, y| overlap(x).total_cmp(&overlap(y)));
    best.or_else(|| pairs.iter().max_by(|x, y| overlap(x).total_cmp(&overlap(y))))
        .map_or([0, 0], |pair| pair.triangles)
}
