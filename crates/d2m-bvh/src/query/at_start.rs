//! How bodies that are in contact at the start of a window meet there: do they touch, or do they overlap?

use super::report::triangles_of_held;
use crate::moving::triangles_of;
use crate::{
    Answered, Contact, Evidence, Meter, Moving, Posed, QueryError, QueryOptions, Solid, StartState,
    TimeOfContact, Window,
};
use d2m_feature::{FeaturePair, TriangleDistance, TriangleFeature, TrianglesAt};
use d2m_lanes::UP;
use d2m_mesh::at_rest::{Meeters, Meeting, bound_distance_metered};
use d2m_mesh::margin::{length, sum_of_radii};
use d2m_motion::Pose;
use glam::{DMat3, DVec3};

/// The answer with what is proven of the start, if it is a contact there. What the decision costs counts as work.
pub(super) fn judged(
    answered: &Answered<TimeOfContact>,
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
) -> Result<Answered<TimeOfContact>, QueryError> {
    let Answered { answer, mut work } = *answered;
    let TimeOfContact::Contact(contact) = answer else { return Ok(*answered) };
    let mut meter = Meter::new(&options.budget);
    meter.spend(work.work());
    let before = meter.spent();
    let contact = judge(contact, bodies, window, options, &mut meter)?;
    work.node_tests += meter.spent() - before;
    Ok(Answered { answer: TimeOfContact::Contact(contact), work })
}

/// The contact with what is proven of the start.
pub(super) fn judge(
    contact: Contact,
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    meter: &mut Meter,
) -> Result<Contact, QueryError> {
    let time = window.start();
    if contact.time_lo > time || !matches!(contact.start, StartState::Touching | StartState::Overlapping) {
        return Ok(contact);
    }
    let solids = bodies.map(|body| body.solid_in(options));
    let Some(meeting) = meeting_at(bodies, solids, time, meter)? else {
        return nearest_of_rounded(contact, bodies, meter);
    };
    let crossing =
        |triangles: &[u32; 2]| TrianglesAt::new(&triangles_of(bodies, *triangles), time).certainly_cross();
    Ok(match meeting {
        Meeting::Touching(touch) => {
            let found = of_pair(contact, bodies, touch.triangles, touch.normal);
            Contact { start: StartState::Touching, ..found }
        }
        Meeting::Overlapping(triangles) => {
            let found = match triangles.filter(crossing) {
                Some(triangles) => Contact {
                    evidence: Evidence::Crossing,
                    time_hi: contact.time_lo,
                    ..of_pair(contact, bodies, triangles, contact.normal)
                },
                None => contact,
            };
            Contact { start: StartState::Overlapping, separation: 0.0, ..found }
        }
        Meeting::Holding(held) => {
            let triangles = triangles_of_held(&held, bodies.each_ref().map(|body| body.body));
            Contact {
                start: StartState::Contained,
                separation: 0.0,
                evidence: Evidence::Crossing,
                time_hi: contact.time_lo,
                ..of_pair(contact, bodies, triangles, contact.normal)
            }
        }
        // What could not be decided of the bodies may be known of the reported triangles: in units so small that underflow takes a part of all lengths.
        Meeting::Undecided
            if contact.evidence == Evidence::Crossing
                && crossing(&[contact.triangle_a, contact.triangle_b]) =>
        {
            Contact { start: StartState::Overlapping, separation: 0.0, time_hi: time, ..contact }
        }
        // The separation is still that of the reported triangles.
        Meeting::Undecided => Contact { start: StartState::Undecided, ..contact },
    })
}

/// The contact of bodies whose meshes are apart, as that of the nearest triangles if these are within the radii: a search that a minimum
/// separation ends, or one that ends early, reports any two that are near enough, while others may be further in each other.
fn nearest_of_rounded(
    contact: Contact,
    bodies: &[Moving<'_>; 2],
    meter: &mut Meter,
) -> Result<Contact, QueryError> {
    let [least, most] = sum_of_radii(bodies.map(|body| body.radius));
    if most == 0.0 {
        return Ok(contact);
    }
    let pose = |body: &Moving<'_>| body.motion.pose_and_twist(contact.time_lo).0;
    let posed = [0, 1].map(|k| Posed::new(bodies[k].body, pose(&bodies[k])));
    let found = bound_distance_metered(posed, [Solid::Surface; 2], meter)?;
    let triangles = [found.triangle_a, found.triangle_b];
    Ok(match found.distance {
        Some(nearest) if nearest.lower >= most => contact,
        Some(nearest) => of_pair(contact, bodies, triangles, nearest.normal),
        None if found.upper < least => of_pair(contact, bodies, triangles, contact.normal),
        // The budget has ended before it is known.
        None => Contact { start: StartState::Undecided, ..contact },
    })
}

/// Node tests of each part of the decision: bodies that touch all over would take as many as they have pairs.
const PATIENCE: u64 = 1 << 12;

/// How the bodies meet at a time; `None`: their meshes are apart, and none holds the other.
pub(super) fn meeting_at<'a>(
    bodies: &[Moving<'a>; 2],
    solids: [Solid; 2],
    time: f64,
    meter: &mut Meter,
) -> Result<Option<Meeting<'a>>, QueryError> {
    let mut poses = bodies.map(|body| body.motion.pose_and_twist(time).0);
    let origin = poses[1].translation;
    let mut blur = 0.0;
    for (body, pose) in bodies.iter().zip(&mut poses) {
        let given = body.motion.constant_twist_from(time).map(|piece| piece.motion);
        match given.filter(|motion| motion.reference_time() == time) {
            // The pose as it was given.
            Some(motion) => {
                *pose =
                    Pose { translation: motion.position(), rotation: motion.orientation(), at: motion.at() };
            }
            None => blur += deviation(body, pose, time, origin),
        }
    }
    let posed = [0, 1].map(|k| Posed::new(bodies[k].body, poses[k]));
    Meeters { bodies: posed, solids, blur, patience: PATIENCE }.meeting(meter)
}

/// How far a point of a body may be from where the pose, which is rounded, places it; of a motion that knows nothing of itself at that time
/// infinite, or no number.
pub(super) fn deviation(body: &Moving<'_>, pose: &Pose, time: f64, origin: DVec3) -> f64 {
    let state = body.motion.enclose_state_about(time, origin);
    let turn = DMat3::from_quat(pose.rotation.normalize());
    let place = turn * (state.at - pose.at) + (pose.translation - origin);
    let apart = turn - state.rotation;
    let turned = length(apart.x_axis) + length(apart.y_axis) + length(apart.z_axis);
    let reach = body.body.radius() + length(body.body.center() - state.at) + length(state.at - pose.at);
    // Each difference and product rounds by less than 16u of the lengths that enter.
    let lengths = length(pose.translation - origin) + length(origin) + reach;
    let rounding = 8.0 * f64::EPSILON * lengths;
    let off = length(place - state.position) + state.position_radius;
    (off + (turned + state.rotation_radius) * reach + rounding) * UP
}

/// The contact with the data of these two triangles, and this normal.
pub(super) fn of_pair(
    contact: Contact,
    bodies: &[Moving<'_>; 2],
    triangles: [u32; 2],
    normal: DVec3,
) -> Contact {
    let placed = TrianglesAt::new(&triangles_of(bodies, triangles), contact.time_lo);
    let near = placed.distance();
    let closing_speed = placed.closing_speed(&near, normal);
    let [triangle_a, triangle_b] = triangles;
    Contact {
        separation: near.upper,
        normal,
        point_a: placed.world(near.point_a),
        point_b: placed.world(near.point_b),
        barycentric_a: near.barycentric_a,
        barycentric_b: near.barycentric_b,
        triangle_a,
        triangle_b,
        feature: features(bodies, triangles, &near),
        closing_speed,
        ..contact
    }
}

/// The features that hold the closest points of two triangles, by ids in the meshes.
fn features(bodies: &[Moving<'_>; 2], triangles: [u32; 2], near: &TriangleDistance) -> FeaturePair {
    let corners = [0, 1].map(|k| bodies[k].body.mesh().triangles()[triangles[k] as usize]);
    let edge = |body: usize, from: u8| {
        let (p, q) = (corners[body][from as usize], corners[body][(from as usize + 1) % 3]);
        [p.min(q), p.max(q)]
    };
    let corner = |body: usize, number: u8| corners[body][number as usize];
    match [near.feature_a, near.feature_b] {
        [TriangleFeature::Edge(i), TriangleFeature::Edge(j)] => {
            FeaturePair::EdgeEdge { edge_a: edge(0, i), edge_b: edge(1, j) }
        }
        [TriangleFeature::Vertex(i), _] => {
            FeaturePair::VertexFace { vertex: corner(0, i), face: triangles[1] }
        }
        [_, TriangleFeature::Vertex(j)] => {
            FeaturePair::FaceVertex { face: triangles[0], vertex: corner(1, j) }
        }
        // A face that meets an edge or a face within it: a corner stands for the other triangle.
        [TriangleFeature::Face, _] => FeaturePair::FaceVertex { face: triangles[0], vertex: corner(1, 0) },
        [_, TriangleFeature::Face] => FeaturePair::VertexFace { vertex: corner(0, 0), face: triangles[1] },
    }
}
