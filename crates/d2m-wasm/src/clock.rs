//! How long a query takes: the standard library has no clock on `wasm32-unknown-unknown`.

use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// Milliseconds since the page was opened, as pages, workers and Node have it.
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
}

/// Calls a function; its result with the microseconds that it took.
pub(crate) fn timed<T>(call: impl FnOnce() -> T) -> (T, f64) {
    let start = now();
    let result = call();
    (result, (now() - start) * 1e3)
}
