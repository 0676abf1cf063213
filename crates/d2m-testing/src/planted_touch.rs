//! Convex bodies that touch, planted: where, along which normal, and by what features is known.
use crate::{Draw, Surface};
use glam::{DQuat, DVec3};

/// What touches what; the first is a feature of A.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// A vertex of B in a face.
    Vertex,
    /// A face of B in a face.
    Face,
    /// An edge of B in a face.
    EdgeInFace,
    /// An edge of B across an edge.
    EdgeAcrossEdge,
}

impl Touch {
    /// Each of them.
    pub const ALL: [Self; 4] = [Self::Vertex, Self::Face, Self::EdgeInFace, Self::EdgeAcrossEdge];
}

/// Two convex bodies that touch where B is shifted, to rounding.
#[derive(Clone, Debug)]
pub struct PlantedTouch {
    /// Both, in one frame.
    pub bodies: [Surface; 2],
    /// Where B touches A.
    pub shift: DVec3,
    /// Unit normal from A to B: along it they part.
    pub normal: DVec3,
    /// The distance of the farthest vertex from the origin.
    pub size: f64,
}

/// What the numbers of a planted touch may be off by, in sizes.
const ROUNDING: f64 = 1e-12;

impl PlantedTouch {
    /// Two bodies that touch so. `None` where the features that were drawn have no plane between the bodies (an inner diagonal of a side
    /// has no edge across it).
    ///
    /// ```
    /// use d2m_testing::{KnuthRandom, PlantedTouch, Touch};
    /// let mut random = KnuthRandom(1);
    /// let touch = (0..9).find_map(|_| PlantedTouch::draw(&mut random, Touch::Vertex)).unwrap();
    /// let [a, b] = &touch.bodies;
    /// let high = a.vertices.iter().map(|p| p.dot(touch.normal)).fold(f64::NEG_INFINITY, f64::max);
    /// let low = b.vertices.iter().map(|p| (*p + touch.shift).dot(touch.normal)).fold(f64::INFINITY, f64::min);
    /// assert!((high - low).abs() < 1e-11 * touch.size);
    /// ```
    pub fn draw(random: &mut impl Draw, touch: Touch) -> Option<Self> {
        let (a, b) = (convex(random), convex(random));
        let (n, point, corners) = face(random, &a);
        let (b, normal, shift) = match touch {
            Touch::Vertex => {
                let turn = DQuat::from_rotation_arc(random.direction(), n);
                let b = b.map(|p| turn * p);
                let height = |p: &DVec3| p.dot(n);
                let lowest = b.vertices.iter().copied().min_by(|p, q| height(p).total_cmp(&height(q)))?;
                (b, n, point - lowest)
            }
            Touch::Face => {
                let (m, middle, _) = face(random, &b);
                let turn = DQuat::from_rotation_arc(m, -n);
                (b.map(|p| turn * p), n, point - turn * middle)
            }
            Touch::EdgeInFace => {
                // Its neighbors above the plane of the face.
                let (m, _, [p, q, _]) = face(random, &b);
                let (edge, middle) = ((q - p).normalize(), (p + q) * 0.5);
                let lean = |angle: f64| DQuat::from_rotation_arc(m, -n) * DQuat::from_axis_angle(edge, angle);
                let is_above = |way: &DQuat| b.vertices.iter().all(|v| (*way * (*v - middle)).dot(n) > -1e-9);
                let way = Some(lean(0.05)).filter(is_above).unwrap_or_else(|| lean(-0.05));
                (b.map(|p| way * p), n, point - way * middle)
            }
            Touch::EdgeAcrossEdge => {
                // Out of both, in the middle of both pairs of faces.
                let [p, q, _] = corners;
                let (_, _, [r, s, _]) = face(random, &b);
                let ((e, up), (f, down)) = (out_of(&a, p, q), out_of(&b, r, s));
                // B's edge across A's, its outward direction against A's.
                let align = DQuat::from_rotation_arc(down, -up);
                let (across, wanted) = (align * f, up.cross(e).normalize());
                let angle = across.cross(wanted).dot(up).atan2(across.dot(wanted));
                let way = DQuat::from_axis_angle(up, angle) * align;
                (b.map(|p| way * p), up, (p + q) * 0.5 - way * ((r + s) * 0.5))
            }
        };
        let size = a.vertices.iter().chain(&b.vertices).map(|p| p.length()).fold(0.0, f64::max);
        let high = a.vertices.iter().map(|p| normal.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
        let low = b.vertices.iter().map(|p| normal.dot(*p + shift)).fold(f64::INFINITY, f64::min);
        (low >= high - ROUNDING * size).then_some(Self { bodies: [a, b], shift, normal, size })
    }
}

/// A box or a tetrahedron, turned and scaled.
fn convex(random: &mut impl Draw) -> Surface {
    let turn = random.moderate_turn().normalize();
    let size = random.log_between(0.1, 10.0);
    if random.unit() < 0.5 {
        let half = DVec3::new(random.between(0.2, 1.0), random.between(0.2, 1.0), random.between(0.2, 1.0));
        return Surface::cuboid(-half, half).map(|p| turn * p * size);
    }
    let corners = [
        DVec3::new(0.0, 0.0, 1.0),
        DVec3::new(-0.8, -0.5, -0.4),
        DVec3::new(0.9, -0.5, -0.3),
        DVec3::new(0.0, 0.9, -0.4),
    ];
    let solid = Surface::tetrahedron(corners);
    let solid = if solid.signed_volume() < 0.0 { solid.inverted() } else { solid };
    solid.map(|p| turn * p * size)
}

/// A random triangle of a surface: its outward unit normal, a point well inside of it, its corners.
fn face(random: &mut impl Draw, surface: &Surface) -> (DVec3, DVec3, [DVec3; 3]) {
    let triangle = surface.triangles[random.index(surface.triangles.len())];
    let [p, q, r] = triangle.map(|v| surface.vertices[v as usize]);
    let (s, t) = (random.between(0.2, 0.4), random.between(0.2, 0.4));
    ((q - p).cross(r - p).normalize(), p + (q - p) * s + (r - p) * t, [p, q, r])
}

/// The direction of an edge, and the one across it away from the middle of the body.
fn out_of(surface: &Surface, p: DVec3, q: DVec3) -> (DVec3, DVec3) {
    let center = surface.vertices.iter().copied().sum::<DVec3>() / surface.vertices.len() as f64;
    let edge = (q - p).normalize();
    let out = (p + q) * 0.5 - center;
    (edge, (out - edge * out.dot(edge)).normalize())
}
