//! What a part of a body sweeps out while the body turns about its axis, whatever the angle: its points stay on circles.

use super::axis_distance::{distance_in_plane, distance_squared_in_plane};
use crate::pair::scene::SceneBody;
use d2m_mesh::margin::UNIT_F32;
use d2m_mesh::node::{Below, WIDTH};
use d2m_mesh::{Exhausted, Meter};
use glam::{DVec2, DVec3};

/// Axes of boxes are rounded to `f32` and orthonormal up to 5.2·2⁻²⁴ (docs/theory/engine.md): a box reaches no further
/// than its half extents say and this part of its radius.
const AXES_ERROR: f64 = 6.0 * UNIT_F32;
/// How much less the size of a part of a spinning body counts. Its parts are much like each other: they come last.
const SPINNING_SIZE: f64 = 1.0 / 1024.0;

/// Where a part of a body lies about its axis: heights and distances, bounds of what the points have.
#[derive(Clone, Copy, Debug)]
pub(super) struct AnnularBound {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) near: f64,
    pub(super) far: f64,
}

impl AnnularBound {
    pub(super) const NONE: Self =
        Self { low: f64::INFINITY, high: f64::NEG_INFINITY, near: f64::INFINITY, far: 0.0 };

    pub(super) fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            near: self.near.min(other.near),
            far: self.far.max(other.far),
        }
    }

    /// Of a triangle, corners from a point of the axis, which is the third coordinate.
    pub(super) fn of(corners: &[DVec3; 3]) -> Self {
        let flat = corners.map(DVec3::truncate);
        let near = distance_squared_in_plane(&flat, &flat.map(DVec2::length_squared)).sqrt();
        Self { near, ..Self::filled(corners) }
    }

    /// The same without the least distance from the axis.
    fn filled(corners: &[DVec3; 3]) -> Self {
        let [low, high] = [f64::min, f64::max].map(|f| f(f(corners[0].z, corners[1].z), corners[2].z));
        let squares = corners.map(|corner| corner.truncate().length_squared());
        Self { low, high, near: 0.0, far: squares[0].max(squares[1]).max(squares[2]).sqrt() }
    }
}

/// One body over the rest of the query.
pub(super) struct SweptBody<'a> {
    pub(super) body: &'a SceneBody<'a>,
    /// Axes of the body and the tree's center from the reference point, world axes, at the start.
    pub(super) rotation: [DVec3; 3],
    pub(super) arm: DVec3,
    /// Axis of the spin, or a direction of interest for a body at rest.
    pub(super) axis: DVec3,
    pub(super) spins: bool,
    /// Angular velocity that a body at rest has after all.
    pub(super) turning: DVec3,
    /// Of each box, by number; empty until the body is [measured](Self::measure).
    pub(super) annuli: Vec<AnnularBound>,
}

impl<'a> SweptBody<'a> {
    /// A body that turns about its own axis.
    pub(super) fn spinning(body: &'a SceneBody<'a>, start: f64) -> Self {
        let axis = body.motion.turning().axis();
        Self { spins: true, turning: DVec3::ZERO, ..Self::resting(body, start, axis) }
    }

    /// A body that hardly turns.
    pub(super) fn resting(body: &'a SceneBody<'a>, start: f64, axis: DVec3) -> Self {
        let motion = &body.motion;
        let rotation = motion.rotation(start);
        let turn = |p: DVec3| rotation[0] * p.x + rotation[1] * p.y + rotation[2] * p.z;
        Self {
            body,
            rotation,
            arm: turn(motion.arm()),
            axis,
            spins: false,
            turning: motion.angular_velocity(),
            annuli: Vec::new(),
        }
    }

    /// Of a triangle in coordinates of the axis. The least distance from it counts for bodies that spin only.
    fn annulus(&self, corners: &[DVec3; 3]) -> AnnularBound {
        if self.spins { AnnularBound::of(corners) } else { AnnularBound::filled(corners) }
    }

    fn turn(&self, p: DVec3) -> DVec3 {
        let r = &self.rotation;
        r[0] * p.x + r[1] * p.y + r[2] * p.z
    }

    /// Corners of a triangle from the reference point.
    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.body.corners(triangle).map(|p| self.turn(p) + self.arm)
    }

    /// Takes points from the reference point to coordinates of which the third one runs along the axis.
    fn to_axis_coordinates(&self) -> impl Fn(DVec3) -> DVec3 + use<> {
        let across = self.axis.any_orthonormal_vector();
        let rows = [across, self.axis.cross(across), self.axis];
        move |p| DVec3::from_array(rows.map(|row| row.dot(p)))
    }

    /// Fills in the annuli of all boxes.
    pub(super) fn measure(&mut self, clock: &mut Meter) -> Result<(), Exhausted> {
        let (to_axis, tree) = (self.to_axis_coordinates(), self.body.tree);
        let place = |&p: &DVec3| {
            clock.step()?;
            Ok(to_axis(self.turn(self.body.place(p)) + self.arm))
        };
        let places = tree.mesh().vertices().iter().map(place).collect::<Result<Vec<DVec3>, _>>()?;
        self.annuli = vec![AnnularBound::NONE; tree.nodes().len() * WIDTH];
        self.measure_node(0, &places, clock).map(|_| ())
    }

    fn measure_node(
        &mut self,
        node: usize,
        places: &[DVec3],
        clock: &mut Meter,
    ) -> Result<AnnularBound, Exhausted> {
        let mut all = AnnularBound::NONE;
        let tree = self.body.tree;
        for lane in 0..tree.nodes()[node].used as usize {
            clock.step()?;
            let annulus = match tree.nodes()[node].below(lane) {
                Below::Triangle(triangle) => {
                    let corners = tree.mesh().triangles()[triangle as usize];
                    self.annulus(&corners.map(|vertex| places[vertex as usize]))
                }
                Below::Node(below) => self.measure_node(below as usize, places, clock)?,
            };
            self.annuli[node * WIDTH + lane] = annulus;
            all = all.with(annulus);
        }
        Ok(all)
    }

    /// A triangle whatever box holds it.
    pub(super) fn triangle(&self, triangle: u32) -> SweptPart<'_> {
        let corners = self.corners(triangle);
        let center = (corners[0] + corners[1] + corners[2]) / 3.0;
        SweptPart {
            body: self,
            annulus: self.annulus(&corners.map(self.to_axis_coordinates())),
            center,
            axes: [DVec3::ZERO; 3],
            half: [0.0; 3],
            radius: corners.iter().map(|p| (*p - center).length()).fold(0.0, f64::max),
            corners: Some(corners),
            below: Below::Triangle(triangle),
            reach: self.reach_from_spin(&corners),
        }
    }

    /// A box. As long as the body is not measured its annulus is that of the box, without the roundings: an estimate.
    pub(super) fn part(&self, index: u32) -> SweptPart<'_> {
        let (node, lane) = (&self.body.tree.nodes()[index as usize / WIDTH], index as usize % WIDTH);
        let boxed = node.oriented_box(lane);
        let unit = self.body.box_unit();
        let local =
            DVec3::from_array([0, 1, 2].map(|k| f64::from(node.origin[k]) + f64::from(boxed.center[k])));
        let center = self.turn(local * unit) + self.arm;
        let below = node.below(lane);
        let corners = match below {
            Below::Triangle(triangle) => Some(self.corners(triangle)),
            Below::Node(_) => None,
        };
        let axes = boxed.axes.map(|axis| self.turn(DVec3::from_array(axis.map(f64::from))));
        let half = boxed.half_extent.map(|h| f64::from(h) * unit);
        let radius = f64::from(boxed.radius) * unit;
        let annulus = match (self.annuli.get(index as usize), &corners) {
            (Some(annulus), _) => *annulus,
            (None, Some(corners)) => self.annulus(&corners.map(self.to_axis_coordinates())),
            (None, None) => {
                let [height, extent] = [
                    self.axis.dot(center),
                    axes.iter().zip(half).map(|(axis, half)| half * self.axis.dot(*axis).abs()).sum(),
                ];
                let distance = (center - self.axis * height).length();
                let near = (distance - radius).max(0.0);
                AnnularBound { low: height - extent, high: height + extent, near, far: distance + radius }
            }
        };
        let reach =
            corners.map_or_else(|| self.reach_from_spin(&[center]) + radius, |c| self.reach_from_spin(&c));
        SweptPart { body: self, annulus, center, axes, half, radius, corners, below, reach }
    }

    /// The largest distance of points from the axis about which a body at rest turns after all. It stays what it is.
    fn reach_from_spin(&self, points: &[DVec3]) -> f64 {
        let axis = self.body.motion.turning().axis();
        let across = |p: &DVec3| (*p - axis * axis.dot(*p)).length_squared();
        points.iter().map(across).fold(0.0, f64::max).sqrt()
    }
}

/// Bounds of the distances of points from an axis.
pub(super) struct Distances {
    pub(super) near: f64,
    pub(super) far: f64,
}

/// A box of a body, or a triangle.
pub(super) struct SweptPart<'b> {
    pub(super) body: &'b SweptBody<'b>,
    pub(super) annulus: AnnularBound,
    /// From the reference point, world axes at the start.
    pub(super) center: DVec3,
    pub(super) axes: [DVec3; 3],
    pub(super) half: [f64; 3],
    pub(super) radius: f64,
    pub(super) corners: Option<[DVec3; 3]>,
    pub(super) below: Below,
    /// The largest distance of its points from the axis of the spin, for a body at rest.
    pub(super) reach: f64,
}

impl SweptPart<'_> {
    /// The boxes that it consists of, by number.
    pub(super) fn children(&self) -> std::ops::Range<u32> {
        let Below::Node(node) = self.below else { return 0..0 };
        let first = node * WIDTH as u32;
        first..first + self.body.body.tree.nodes()[node as usize].used
    }

    /// How far the part's swept volume reaches along a unit direction, from the reference point.
    pub(super) fn reach(&self, n: DVec3) -> f64 {
        // Each point is at most `far` from the axis at a height of the range.
        let along = n.dot(self.body.axis);
        let height = if along > 0.0 { along * self.annulus.high } else { along * self.annulus.low };
        let annulus = height + (n - self.body.axis * along).length() * self.annulus.far;
        if self.body.spins {
            return annulus;
        }
        if let Some(corners) = &self.corners {
            return n.dot(corners[0]).max(n.dot(corners[1])).max(n.dot(corners[2]));
        }
        let boxed: f64 = (0..3).map(|i| self.half[i] * n.dot(self.axes[i]).abs()).sum();
        // Boxes are rounded to f32, the range of heights is not.
        (n.dot(self.center) + boxed + AXES_ERROR * self.radius).min(annulus)
    }

    /// Bounds of the distances of the part's points, at all angles, from the axis of the other body, which goes through
    /// `from` (from the reference point) along `axis`.
    pub(super) fn distances(&self, from: DVec3, axis: DVec3) -> Distances {
        let across = |p: DVec3| p - axis * axis.dot(p);
        let apart = across(from);
        if self.body.spins {
            // Projections across two axes differ by the sine of the angle between them.
            let farthest = self.annulus.far + self.annulus.low.abs().max(self.annulus.high.abs());
            let shift = apart.length() + self.body.axis.cross(axis).length() * farthest;
            return Distances { near: (self.annulus.near - shift).max(0.0), far: self.annulus.far + shift };
        }
        if let Some(corners) = &self.corners {
            let flat = corners.map(|p| across(p - from));
            let far = flat.iter().map(|p| p.length()).fold(0.0, f64::max);
            return Distances { near: distance_in_plane(&flat, axis), far };
        }
        let middle = across(self.center - from).length();
        Distances { near: (middle - self.radius).max(0.0), far: middle + self.radius }
    }

    /// What decides which part is expanded.
    pub(super) fn size(&self) -> f64 {
        if self.body.spins {
            SPINNING_SIZE * ((self.annulus.high - self.annulus.low) + (self.annulus.far - self.annulus.near))
        } else {
            self.radius
        }
    }
}
