//! `d2m info`: what is in a mesh, and which shapes there are.

use crate::arguments::InfoArguments;
use crate::failure::Failure;
use crate::load::Loaded;
use crate::output::{Output, print, printable, require_distinct, short};
use crate::sizes::load_one;
use d2m::bvh::{EnclosingSphere, MeshParts, Validation};
use d2m::shapes::{COMMON, SHAPES};
use d2m_io::{Precision, UpAxis, glb_bytes, obj_text, ply_bytes};
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// Runs the command.
pub(crate) fn run(arguments: &InfoArguments) -> Result<(), Failure> {
    let Some(source) = &arguments.mesh else {
        return print(&if arguments.json { shapes_json() } else { shapes_text() });
    };
    let output = |path: &Option<String>, option: &str| match path {
        Some(path) => {
            Output::new(path)?.spare([Path::new(source)])?.called(&format!("--{option}"), &[option]).map(Some)
        }
        None => Ok(None),
    };
    let [obj, ply, glb] =
        [output(&arguments.obj, "obj")?, output(&arguments.ply, "ply")?, output(&arguments.glb, "glb")?];
    // Standard output has the answer.
    require_distinct([&obj, &ply, &glb].into_iter().flatten().chain([&Output::Stdout]))?;
    let body = load_one(source, &arguments.size)?;
    [&obj, &ply, &glb].into_iter().flatten().try_for_each(Output::spare_inputs)?;
    // A large mesh takes a second for each.
    let (validation, parts) = rayon::join(|| Validation::new(body.mesh()), || MeshParts::new(body.mesh()));
    if let Some(obj) = obj {
        obj.write(&format!("# {}\n{}", printable(source), obj_text(body.mesh())))?;
    }
    if let Some(ply) = ply {
        ply.write_bytes(&ply_bytes(body.mesh()))?;
    }
    if let Some(glb) = glb {
        let bytes = glb_bytes(body.mesh());
        glb.write_bytes(
            &bytes.ok_or_else(|| Failure::at("--glb", "the mesh is larger than the 4 GB of a file"))?,
        )?;
    }
    print(&if arguments.json {
        mesh_json(&body, &validation, &parts)
    } else {
        mesh_text(&body, &validation, &parts)
    })
}

/// Volumes that differ by less than this part are shown once: sums of many triangles round.
const VOLUME_ROUNDING: f64 = 1e-9;

fn mesh_text(body: &Loaded, validation: &Validation, parts: &MeshParts) -> String {
    let sphere = EnclosingSphere::of_mesh(body.mesh());
    let mut text = format!("{}\n", printable(&body.name));
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<12}{value}"); // writing to a string cannot fail
    };
    let [low, high] = [validation.bounds_low, validation.bounds_high];
    line("vertices", body.mesh().vertex_count().to_string());
    line("triangles", body.mesh().triangle_count().to_string());
    line(
        "surface",
        match (validation.watertight, validation.consistently_oriented) {
            (true, true) if validation.signed_volume == 0.0 => "encloses nothing".to_owned(),
            (true, true) if validation.signed_volume < 0.0 => "watertight, oriented inwards".to_owned(),
            (true, true) => "watertight, oriented outwards".to_owned(),
            (true, false) => "watertight, but faces disagree about the outside".to_owned(),
            (false, _) => "open: usable with --surface only".to_owned(),
        },
    );
    line(
        "parts",
        format!("{}, Euler characteristic {}", validation.components, validation.euler_characteristic),
    );
    line("area", size(validation.area));
    if validation.consistently_oriented {
        line("volume", size(validation.signed_volume));
        if let Some(volume) = parts.solid_volume
            && (volume - validation.signed_volume).abs() > VOLUME_ROUNDING * validation.signed_volume.abs()
        {
            line("solid", format!("{}, where the winding number is not zero", size(volume)));
        }
    }
    if let Precision::Single(kind) = body.report.precision {
        line("precision", format!("single: a {kind} holds no more than 24 bits of each coordinate"));
    }
    if let Some(unit) = body.unit {
        line("unit", format!("{}, as the option says: read as meters", unit.symbol()));
    } else if let Some(meters) = body.report.meters_per_unit.filter(|meters| *meters != 1.0) {
        line("unit", format!("{} m in the file: read as meters", short(meters)));
    }
    if let Some(axis @ (UpAxis::X | UpAxis::Y)) = body.report.up_axis {
        line("up", format!("{axis:?} in the file: nothing is turned for it"));
    }
    line("box", format!("{low:?} to {high:?}"));
    line("sphere", format!("center {:?}, radius {}", sphere.center.to_array(), short(sphere.radius)));
    let polygons = body.report.polygons;
    for (what, count) in [
        ("polygons cut into triangles", polygons.cut),
        ("of them not flat: the cut decides their shape", polygons.bent),
        ("of them crossing themselves: their triangles overlap", polygons.crossing),
        ("faces with fewer than three corners, left out", polygons.without_area),
        ("degenerate triangles", validation.degenerate_triangles),
        ("repeated triangles", validation.duplicate_triangles),
        ("vertices at the place of another", validation.duplicate_vertices),
        ("unused vertices", validation.unused_vertices),
        ("boundary edges", validation.boundary_edges),
        ("edges with more than two triangles", validation.non_manifold_edges),
        ("edges whose triangles disagree about the outside", validation.inconsistent_edges),
        ("vertices that alone hold the surface together (pinched)", validation.pinched_vertices),
        ("pairs of parts cross or touch: solid where the winding number is not zero", parts.crossing.len()),
        ("parts inside out: solid all the same", parts.inverted_count()),
    ] {
        if count > 0 {
            line("note", format!("{count} {what}"));
        }
    }
    text
}

/// An area or a volume: six digits after the point where they are significant.
fn size(number: f64) -> String {
    match number.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e9).contains(&size) => format!("{number:.6}"),
        _ => format!("{number:.6e}"),
    }
}

fn mesh_json(body: &Loaded, validation: &Validation, parts: &MeshParts) -> String {
    let sphere = EnclosingSphere::of_mesh(body.mesh());
    let object = json!({
        "name": body.name,
        "vertices": body.mesh().vertex_count(),
        "triangles": body.mesh().triangle_count(),
        "enclosing_sphere": { "center": sphere.center.to_array(), "radius": sphere.radius },
        "precision": match body.report.precision {
            Precision::Double => "double",
            Precision::Single(_) => "single",
        },
        "meters_per_unit": body.report.meters_per_unit,
        "polygons": {
            "cut": body.report.polygons.cut,
            "bent": body.report.polygons.bent,
            "crossing": body.report.polygons.crossing,
            "without_area": body.report.polygons.without_area,
        },
        "validation": validation,
        "parts": parts,
    });
    format!("{object}\n")
}

fn shapes_text() -> String {
    let mut text = "Built-in shapes: shape:NAME or shape:NAME?parameter=value&parameter=value\n".to_owned();
    let shapes = SHAPES.iter().map(|shape| (shape.name, shape.description, shape.parameters));
    for (name, description, parameters) in shapes.chain([("every shape", "takes besides its own", COMMON)]) {
        let _ = writeln!(text, "\n{name}: {description}");
        for parameter in parameters {
            let _ = writeln!(
                text,
                "  {:<10} {} [default {}, {} to {}]",
                parameter.name, parameter.description, parameter.default, parameter.low, parameter.high
            );
        }
    }
    text
}

fn shapes_json() -> String {
    let shapes: Vec<_> = SHAPES
        .iter()
        .map(|shape| {
            let parameters: Vec<_> = shape
                .parameters
                .iter()
                .chain(COMMON)
                .map(|p| {
                    json!({
                        "name": p.name, "description": p.description, "default": p.default,
                        "low": p.low, "high": p.high, "integer": p.integer,
                    })
                })
                .collect();
            json!({ "name": shape.name, "description": shape.description, "parameters": parameters })
        })
        .collect();
    format!("{}\n", json!(shapes))
}
