//! Small closed meshes of the hostile families.
use d2m_testing::{Surface, Xoshiro256 as Random};
use glam::DVec3;
use std::collections::BTreeMap;

/// A box with these half extents about the origin.
pub(super) fn centered_box(half: DVec3) -> Surface {
    Surface::cuboid(-half, half)
}

/// A polygon in the plane of x and z, counter-clockwise seen against y, drawn out over `y` in [−1, 1]·half. The
/// polygon must be visible from its first corner.
pub(super) fn extruded(profile: &[(f64, f64)], half: f64) -> Surface {
    let n = profile.len() as u32;
    let at = |y: f64| profile.iter().map(move |(x, z)| DVec3::new(*x, y, *z));
    let vertices = at(-half).chain(at(half)).collect();
    let mut triangles = Vec::new();
    for i in 1..n - 1 {
        triangles.extend([[0, i, i + 1], [n, n + i + 1, n + i]]);
    }
    for i in 0..n {
        let j = (i + 1) % n;
        triangles.extend([[i, n + j, j], [i, n + i, n + j]]);
    }
    Surface { name: "extruded polygon", vertices, triangles }
}

/// A plate whose upper side rises by `step` where x becomes positive.
pub(super) fn stepped_plate(step: f64) -> Surface {
    // From the corner at the foot of the step every other one is visible.
    let profile = [(0.0, 0.0), (-2.0, 0.0), (-2.0, -1.0), (2.0, -1.0), (2.0, step), (0.0, step)];
    oriented(extruded(&profile, 1.0))
}

/// A square crowd of separate spikes of about this height on a base of 2 × 2, tips at z = height, slightly uneven.
pub(super) fn spikes(random: &mut Random, side: u32, height: f64) -> Surface {
    let mut crowd = Surface::default();
    let pitch = 2.0 / f64::from(side);
    let uneven = if random.unit() < 0.5 { 0.0 } else { 10f64.powf(random.range(-6.0, -1.0)) };
    for k in 0..side * side {
        let place = DVec3::new(f64::from(k % side) + 0.5, f64::from(k / side) + 0.5, 0.0) * pitch;
        let tall = height * (1.0 - uneven * random.unit());
        let tip = place + DVec3::new(-1.0, -1.0, tall);
        crowd = crowd.with(&Surface::cone(3, 0.4 * pitch, -tall).map(|p| p + tip));
    }
    crowd
}

/// A closed tetrahedron of random corners.
pub(super) fn tetrahedron(random: &mut Random, size: f64) -> Surface {
    let vertices = [(); 4].map(|()| random.direction() * (size * random.range(0.3, 1.0)));
    oriented(Surface::tetrahedron(vertices))
}

/// A needle or blade: a tetrahedron stretched by `aspect`.
pub(super) fn sliver(random: &mut Random, aspect: f64) -> Surface {
    let tetrahedron = tetrahedron(random, 1.0);
    let thin = if random.unit() < 0.5 {
        DVec3::new(1.0, 1.0 / aspect, 1.0 / aspect)
    } else {
        DVec3::new(1.0, 1.0, 1.0 / aspect)
    };
    tetrahedron.map(|p| p * thin)
}

/// Every triangle cut in four, so many times: the same surface with more to search.
pub(super) fn refined(mut surface: Surface, times: u32) -> Surface {
    for _ in 0..times {
        let mut middles = BTreeMap::new();
        let mut triangles = Vec::with_capacity(4 * surface.triangles.len());
        for t in &surface.triangles {
            let mut middle = |i: u32, j: u32| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    surface
                        .vertices
                        .push(surface.vertices[i as usize].midpoint(surface.vertices[j as usize]));
                    surface.vertices.len() as u32 - 1
                })
            };
            let [p, q, r] = [middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])];
            triangles.extend([[t[0], p, r], [p, t[1], q], [r, q, t[2]], [p, q, r]]);
        }
        surface.triangles = triangles;
    }
    surface
}

/// Turned outwards if the volume is negative.
fn oriented(surface: Surface) -> Surface {
    if surface.signed_volume() < 0.0 { surface.inverted() } else { surface }
}
