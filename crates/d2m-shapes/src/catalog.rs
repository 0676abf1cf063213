//! Every shape that there is, with its parameters.

use crate::extrusion::{self, Prism};
use crate::surface::Surface;
use crate::values::Values;
use crate::{bodies, sphere, thread, tube};
use glam::DVec3;

/// A number that a shape takes.
///
/// ```
/// let shape = d2m_shapes::SHAPES.iter().find(|shape| shape.name == "box").expect("there are boxes");
/// let x = shape.parameters.iter().find(|parameter| parameter.name == "x").expect("half a size");
/// assert!(x.low < x.default && x.default < x.high && !x.integer);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Parameter {
    /// Its name in the text form.
    pub name: &'static str,
    /// The value if it is not given.
    pub default: f64,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Whether it counts something.
    pub integer: bool,
    /// What it means.
    pub description: &'static str,
}

/// One kind of shape.
///
/// ```
/// let gear = d2m_shapes::SHAPES.iter().find(|shape| shape.name == "gear").expect("there is one");
/// let teeth = gear.parameters.iter().find(|parameter| parameter.name == "teeth").expect("it has them");
/// assert!(teeth.integer && teeth.low <= teeth.default && teeth.default <= teeth.high);
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ShapeInfo {
    /// Its name in the text form.
    pub name: &'static str,
    /// One line about it.
    pub description: &'static str,
    /// Its own parameters; [`COMMON`] ones come on top.
    pub parameters: &'static [Parameter],
    pub(crate) build: fn(&Values) -> Surface,
}

const fn length(
    name: &'static str,
    default: f64,
    low: f64,
    high: f64,
    description: &'static str,
) -> Parameter {
    Parameter { name, default, low, high, integer: false, description }
}

const fn count(
    name: &'static str,
    default: f64,
    low: f64,
    high: f64,
    description: &'static str,
) -> Parameter {
    Parameter { name, default, low, high, integer: true, description }
}

const fn triangles(default: f64, low: f64) -> Parameter {
    count("triangles", default, low, 2e7, "wanted number of triangles; the mesh has the nearest that fits")
}

/// Parameters that every shape has besides its own.
///
/// ```
/// assert!(d2m_shapes::COMMON.iter().any(|parameter| parameter.name == "scale"));
/// let twice = d2m_shapes::mesh("box?x=1&scale=2")?;
/// assert_eq!(twice.vertices()[0].x.abs(), 2.0);
/// # Ok::<(), d2m_shapes::ShapeError>(())
/// ```
pub const COMMON: &[Parameter] = &[length("scale", 1.0, 1e-9, 1e9, "all lengths are multiplied by this")];

/// Every shape that there is, in the order of `d2m info --shapes`.
///
/// ```
/// assert!(d2m_shapes::SHAPES.iter().any(|shape| shape.name == "torus-knot"));
/// ```
pub const SHAPES: &[ShapeInfo] = &[
    ShapeInfo {
        name: "box",
        description: "box with half sizes x, y, z",
        parameters: &[
            triangles(12.0, 12.0),
            length("x", 0.577_350_269_189_625_7, 1e-6, 1e6, "half size along x"),
            length("y", 0.577_350_269_189_625_7, 1e-6, 1e6, "half size along y"),
            length("z", 0.577_350_269_189_625_7, 1e-6, 1e6, "half size along z"),
        ],
        build: |v| bodies::cuboid(v.count("triangles"), DVec3::new(v.get("x"), v.get("y"), v.get("z"))),
    },
    ShapeInfo {
        name: "tetrahedron",
        description: "regular tetrahedron",
        parameters: &[],
        build: |_| bodies::tetrahedron(),
    },
    ShapeInfo {
        name: "icosphere",
        description: "unit sphere from a divided icosahedron",
        parameters: &[triangles(1280.0, 20.0)],
        build: |v| sphere::icosphere(v.count("triangles")),
    },
    ShapeInfo {
        name: "pebble",
        description: "bumpy round stone",
        parameters: &[
            triangles(5120.0, 20.0),
            count("seed", 1.0, 0.0, 1e9, "another stone for each seed"),
            length("roughness", 0.6, 0.0, 1.0, "height of the bumps"),
        ],
        build: |v| sphere::pebble(v.count("triangles"), v.get("seed") as u64, v.get("roughness")),
    },
    ShapeInfo {
        name: "torus",
        description: "ring with a round section, axis z",
        parameters: &[
            triangles(3200.0, 18.0),
            length("tube", 0.3, 0.01, 0.49, "radius of the tube; the ring's outer radius is 1"),
        ],
        build: |v| tube::torus(v.count("triangles"), v.get("tube")),
    },
    ShapeInfo {
        name: "torus-knot",
        description: "knotted tube: p turns about the axis, q about the ring",
        parameters: &[
            triangles(20000.0, 400.0),
            count("p", 2.0, 1.0, 7.0, "turns about the axis"),
            count("q", 3.0, 1.0, 7.0, "turns about the ring; no common divisor with p"),
            length(
                "tube",
                0.3,
                0.01,
                0.45,
                "radius of the tube before scaling; at most 0.9/max(p, q) or 0.45",
            ),
        ],
        build: |v| tube::torus_knot(v.count("triangles"), [v.get("p"), v.get("q")], v.get("tube")),
    },
    ShapeInfo {
        name: "chain-link",
        description: "oblong ring, in the xy plane, long side along y",
        parameters: &[
            triangles(4000.0, 36.0),
            length("straight", 1.5, 0.01, 20.0, "length of the straight sides over the radius of the bends"),
            length("tube", 0.35, 0.01, 0.9, "radius of the tube over the radius of the bends"),
        ],
        build: |v| tube::chain_link(v.count("triangles"), v.get("straight"), v.get("tube")),
    },
    ShapeInfo {
        name: "gear",
        description: "spur gear with a bore, axis z",
        parameters: &[
            triangles(5000.0, 200.0),
            count("teeth", 16.0, 4.0, 400.0, "number of teeth"),
            length("depth", 0.15, 0.01, 0.5, "depth of the teeth; the tip radius is 1 before scaling"),
            length("bore", 0.3, 0.05, 0.45, "radius of the bore"),
            length("thickness", 0.4, 0.001, 4.0, "thickness along z"),
        ],
        build: |v| {
            let prism = Prism { half_height: 0.5 * v.get("thickness"), bore: v.get("bore") };
            extrusion::gear(v.count("triangles"), v.count("teeth"), v.get("depth"), prism)
        },
    },
    ShapeInfo {
        name: "paddle-wheel",
        description: "flat blades on a hub, axis z",
        parameters: &[
            triangles(4000.0, 200.0),
            count("blades", 8.0, 3.0, 24.0, "number of blades"),
            length("thickness", 0.8, 0.001, 4.0, "length along z"),
        ],
        build: |v| {
            let prism = Prism { half_height: 0.5 * v.get("thickness"), bore: 0.1 };
            extrusion::paddle_wheel(v.count("triangles"), v.count("blades"), 0.3, 0.03, prism)
        },
    },
    ShapeInfo {
        name: "screw",
        description: "screw along z with a round head; fits `nut`",
        parameters: &[triangles(7000.0, 2000.0), count("turns", 6.0, 3.0, 40.0, "turns of the thread")],
        build: |v| {
            let turns = v.count("turns");
            thread::screw(v.count("triangles"), turns).scaled(thread::common_scale(turns))
        },
    },
    ShapeInfo {
        name: "nut",
        description: "hexagonal nut on the thread of `screw`, both at the origin; pitch and scale are the screw's",
        parameters: &[
            triangles(5000.0, 1000.0),
            length("clearance", 0.01, 0.0, 0.03, "radial play between the threads, before scaling"),
            count("turns", 6.0, 3.0, 40.0, "turns of the screw's thread, which set the common scale"),
        ],
        build: |v| {
            let (clearance, turns) = (v.get("clearance"), v.count("turns"));
            thread::nut(v.count("triangles"), clearance, turns).scaled(thread::common_scale(turns))
        },
    },
    ShapeInfo {
        name: "shaft",
        description: "cylinder of radius 0.5 and length 1.6, axis z; fits `bearing`",
        parameters: &[triangles(2560.0, 48.0)],
        build: |v| extrusion::cylinder(v.count("triangles"), 0.5, 0.8),
    },
    ShapeInfo {
        name: "bearing",
        description: "ring about `shaft`, both at the origin",
        parameters: &[triangles(2560.0, 64.0), length("clearance", 0.01, 1e-9, 0.2, "radial play")],
        build: |v| extrusion::ring(v.count("triangles"), 0.9, 0.3, 0.5 + v.get("clearance")),
    },
    ShapeInfo {
        name: "hollow-sphere",
        description: "spherical shell: a cavity with a wall",
        parameters: &[triangles(2560.0, 40.0), length("wall", 0.2, 1e-3, 0.9, "thickness of the wall")],
        build: |v| sphere::hollow_sphere(v.count("triangles"), v.get("wall")),
    },
    ShapeInfo {
        name: "hollow-box",
        description: "cubic shell: a cavity with a wall",
        parameters: &[
            triangles(24.0, 24.0),
            length("wall", 0.2, 1e-3, 0.9, "thickness of the wall over half the side"),
        ],
        build: |v| bodies::hollow_box(v.count("triangles"), v.get("wall")),
    },
    ShapeInfo {
        name: "needle",
        description: "double cone along z",
        parameters: &[triangles(16.0, 6.0), length("aspect", 1000.0, 1.0, 1e9, "length over thickness")],
        build: |v| bodies::needle(v.count("triangles"), v.get("aspect")),
    },
    ShapeInfo {
        name: "plate",
        description: "thin square plate of half size 1 across z",
        parameters: &[triangles(12.0, 12.0), length("thickness", 1e-4, 1e-9, 1.0, "thickness along z")],
        build: |v| bodies::cuboid(v.count("triangles"), DVec3::new(1.0, 1.0, 0.5 * v.get("thickness"))),
    },
];
