//! What JavaScript calls: values in, plain objects out, exceptions for bad input.

use crate::mesh::Mesh;
use crate::query::{self, Given};
use d2m::shapes::SHAPES;
use js_sys::{Error, JSON};
use serde_json::{Value, json};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// First contact of two moving bodies, as `d2m toc --json` answers; the options are `{window, tolerance, min_separation, solid, budget,
/// clearance, start, verify}`. Besides, `headline`, `facts` and (unless what is in contact at the start is let go) `spans` state the same in words.
///
/// # Errors
/// Throws an `Error` with the text that the command prints: bad motions, windows and options.
#[wasm_bindgen(js_name = timeOfContact)]
pub fn time_of_contact(
    a: &Mesh,
    motion_a: &JsValue,
    b: &Mesh,
    motion_b: &JsValue,
    options: &JsValue,
) -> Result<JsValue, Error> {
    let ask = query::time_of_contact;
    answer([(a, motion_a, "motion of A"), (b, motion_b, "motion of B")], options, ask)
}

/// The times of a window at which two moving bodies are clear or in contact, as `d2m spans --json` answers; the options are `{window,
/// tolerance, min_separation, solid, budget, resolution, verify}`.
///
/// # Errors
/// As [`time_of_contact`].
#[wasm_bindgen(js_name = contactSpans)]
pub fn contact_spans(
    a: &Mesh,
    motion_a: &JsValue,
    b: &Mesh,
    motion_b: &JsValue,
    options: &JsValue,
) -> Result<JsValue, Error> {
    answer([(a, motion_a, "motion of A"), (b, motion_b, "motion of B")], options, query::contact_spans)
}

/// Least distance of two moving bodies over a window, as `d2m clearance --json` answers; the options are `{window, tolerance, solid,
/// budget, accuracy, verify}`.
///
/// # Errors
/// As [`time_of_contact`].
#[wasm_bindgen]
pub fn clearance(
    a: &Mesh,
    motion_a: &JsValue,
    b: &Mesh,
    motion_b: &JsValue,
    options: &JsValue,
) -> Result<JsValue, Error> {
    answer([(a, motion_a, "motion of A"), (b, motion_b, "motion of B")], options, query::clearance)
}

/// Distance of two bodies at rest, as `d2m distance --json` answers; the options are `{solid}`.
///
/// # Errors
/// As [`time_of_contact`].
#[wasm_bindgen]
pub fn distance(
    a: &Mesh,
    pose_a: &JsValue,
    b: &Mesh,
    pose_b: &JsValue,
    options: &JsValue,
) -> Result<JsValue, Error> {
    answer([(a, pose_a, "pose of A"), (b, pose_b, "pose of B")], options, query::distance)
}

/// The built-in shapes: `[{name, description, parameters: [{name, default, low, high, integer, description}]}]`.
///
/// # Errors
/// None: it throws never.
#[wasm_bindgen]
pub fn shapes() -> Result<JsValue, Error> {
    let shapes = SHAPES.iter().map(|shape| {
        let parameters = shape.parameters.iter().map(|p| {
            let [default, low, high] = [p.default, p.low, p.high];
            json!({ "name": p.name, "default": default, "low": low, "high": high, "integer": p.integer,
                "description": p.description })
        });
        let parameters: Vec<Value> = parameters.collect();
        json!({ "name": shape.name, "description": shape.description, "parameters": parameters })
    });
    object(&shapes.collect())
}

fn answer(
    [a, b]: [(&Mesh, &JsValue, &str); 2],
    options: &JsValue,
    ask: impl FnOnce([Given<'_>; 2], &str) -> Result<Value, String>,
) -> Result<JsValue, Error> {
    let [motion_a, motion_b] = [text(a.1, a.2)?, text(b.1, b.2)?];
    let bodies = [Given { tree: &a.0.tree, motion: &motion_a }, Given { tree: &b.0.tree, motion: &motion_b }];
    let found = ask(bodies, &text(options, "options")?);
    object(&found.map_err(|reason| Error::new(&reason))?)
}

/// JSON as a plain object: JavaScript reads decimals as the nearest doubles, so that each number keeps its bits.
fn object(value: &Value) -> Result<JsValue, Error> {
    JSON::parse(&value.to_string()).map_err(Error::from)
}

/// An object as JSON, a text as it is; what is left out is an empty object.
fn text(value: &JsValue, place: &str) -> Result<String, Error> {
    if value.is_undefined() || value.is_null() {
        return Ok("{}".to_owned());
    }
    if let Some(text) = value.as_string() {
        return Ok(text);
    }
    let json = JSON::stringify(value).map_err(Error::from)?;
    // Of a function there is no JSON.
    json.as_string().ok_or_else(|| Error::new(&format!("{place}: neither an object nor a text")))
}
