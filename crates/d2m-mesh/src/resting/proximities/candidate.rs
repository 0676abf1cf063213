//! A pair of features that passed the tests, and twins of it on neighbouring features.

use d2m_feature::FeaturePair;
use glam::DVec3;

/// Where a point is on its body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) triangle: u32,
    /// Weights of the triangle's corners.
    pub(super) weights: [f64; 3],
}

/// Two features that are locally closest up to rounding; lengths in the working unit, B's axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) feature: FeaturePair,
    pub(super) places: [Place; 2],
    /// The placed points on A and on B.
    pub(super) points: [DVec3; 2],
    /// Unit direction from A to B.
    pub(super) normal: DVec3,
    /// Bound on the error of the direction, as the sine of an angle.
    pub(super) normal_error: f64,
    pub(super) distance: f64,
    /// How far the direction is outside of the cones, beyond its error.
    pub(super) tilt: f64,
    /// Dimensions of the two features together, 0 to 2: of twins the one of the least is kept, because its normal cone
    /// holds those of the others.
    pub(super) dimension: u8,
}

impl Candidate {
    /// What decides between twins, and orders answers of equal distance.
    fn rank(&self) -> (u8, [u32; 6]) {
        (self.dimension, self.name())
    }

    /// By which the pair of features is known.
    fn name(&self) -> [u32; 6] {
        match self.feature {
            FeaturePair::VertexFace { vertex, face } => [0, vertex, 0, face, 0, 0],
            FeaturePair::FaceVertex { face, vertex } => [1, face, 0, vertex, 0, 0],
            FeaturePair::EdgeEdge { edge_a, edge_b } => [2, edge_a[0], edge_a[1], edge_b[0], edge_b[1], 0],
        }
    }
}

/// Drops all but one of the candidates whose points are within `tolerance` of each other on both bodies, and all but the least tilted of those
/// of one name, and sorts by distance.
pub(super) fn without_twins(mut found: Vec<Candidate>, tolerance: f64) -> Vec<Candidate> {
    // Sorted along a direction that planes and edges of models are rarely perpendicular to, twins are close in the list.
    let key = |c: &Candidate| SWEEP.dot(c.points[0]);
    found.sort_by(|a, b| key(a).total_cmp(&key(b)).then_with(|| a.rank().cmp(&b.rank())));
    let keys: Vec<f64> = found.iter().map(key).collect();
    let mut dropped = vec![false; found.len()];
    let square = tolerance * tolerance;
    for i in 0..found.len() {
        // |SWEEP| < 1: points within the tolerance have keys within twice that, roundings included.
        for j in i + 1..found.len() {
            if keys[j] - keys[i] > 2.0 * tolerance {
                break;
            }
            let near = (0..2).all(|k| found[i].points[k].distance_squared(found[j].points[k]) <= square);
            if near && !dropped[i] && !dropped[j] {
                let (kept, twin) = if found[i].rank() <= found[j].rank() { (i, j) } else { (j, i) };
                dropped[twin] = true;
                found[kept].tilt = found[kept].tilt.min(found[twin].tilt);
                // The direction of a face is known better than that between two points close to each other.
                if found[twin].normal_error < found[kept].normal_error {
                    found[kept].normal = found[twin].normal;
                    found[kept].normal_error = found[twin].normal_error;
                }
            }
        }
    }
    let mut index = 0..;
    found.retain(|_| !index.next().is_some_and(|i: usize| dropped[i]));
    // A vertex over the rim of a face is close to the face and, within the slack of the cones, to its edge, which is named as the face is.
    let tilt =
        |a: &Candidate, b: &Candidate| a.tilt.total_cmp(&b.tilt).then(a.distance.total_cmp(&b.distance));
    found
        .sort_by(|a, b| a.name().cmp(&b.name()).then_with(|| tilt(a, b)).then(a.dimension.cmp(&b.dimension)));
    found.dedup_by(|other, least| other.name() == least.name());
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance).then_with(|| a.rank().cmp(&b.rank())));
    found
}

/// A direction of length below one without small ratios of its coordinates.
const SWEEP: DVec3 = DVec3::new(0.314_159_265_358_979_3, 0.271_828_182_845_904_5, 0.864_197_532_086_419_7);
