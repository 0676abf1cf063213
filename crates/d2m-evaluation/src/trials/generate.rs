use super::{Movement, Trial};
use d2m_testing::Xoshiro256 as Random;

/// The law of the trials, in units of the models' radius (farthest vertex from the origin at distance 1).
///
/// Two bodies of bounding radius 1 fly at each other, each at half the relative `speed`, along a direction u
/// uniform on the sphere. Their centers pass at a distance whose vector is uniform in the disk of radius `miss`
/// across u, so most trials hit (nine of ten for solid shapes), some graze and some miss. The bounding spheres
/// are disjoint at the start: on the path, the centers are 2.05 + speed·U(0.05, 0.8) from their closest
/// approach. Orientations are uniform; |angular velocity| is uniform in [0, `spin`] with a uniform direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law {
    /// Relative speed of the centers.
    pub(crate) speed: f64,
    /// Largest angular speed.
    pub(crate) spin: f64,
    /// Exactly `spin` for every body, rather than uniform below it.
    pub(crate) fixed_spin: bool,
    /// Largest distance of closest approach of the centers.
    pub(crate) miss: f64,
}

impl Law {
    /// |ω| up to 3, centers passing at up to 1 radius, speed 4 (the other one is 512).
    pub(crate) const PAPER: Self = Self { speed: 4.0, spin: 3.0, fixed_spin: false, miss: 1.0 };
}

/// `count` trials of this law; the first n of a longer list are the list of n.
pub(crate) fn generate(law: &Law, seed: u64, count: usize) -> Vec<Trial> {
    let mut random = Random::new(seed);
    (0..count).map(|_| draw(law, &mut random)).collect()
}

fn draw(law: &Law, random: &mut Random) -> Trial {
    let along = random.direction();
    let across = loop {
        let v = random.direction();
        if let Some(direction) = (v - along * v.dot(along)).try_normalize() {
            break direction * (law.miss * random.unit().sqrt());
        }
    };
    let lead = 2.05 + law.speed * random.range(0.05, 0.8);
    let half = (along * lead + across) * 0.5;
    let mut movement = |sign: f64| {
        let rotation = random.rotation();
        let spin = if law.fixed_spin { law.spin } else { random.range(0.0, law.spin) };
        Movement {
            rotation,
            position: half * -sign,
            velocity: along * (0.5 * law.speed * sign),
            angular_velocity: random.direction() * spin,
        }
    };
    Trial { a: movement(1.0), b: movement(-1.0) }
}
