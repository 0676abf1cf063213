//! What a scene says of all its pairs: when, at which distance and how exactly they are asked for.

use crate::IoError;
use crate::scene_fault::{check_distance, fault, keys_of};
use crate::scene_pair::parse_start;
use d2m_bvh::{Start, Window};
use serde::Deserialize;
use serde_json::Value;

/// The keys `window`, `min_separation`, `tolerance` and `start` of any scene, checked; none where a key is left out.
///
/// ```
/// use d2m_io::SceneTerms;
/// let terms = SceneTerms::parse(serde_json::json!({"window": [0, 2], "tolerance": 1e-9}))?;
/// assert_eq!((terms.window.map(|window| window.end()), terms.tolerance, terms.min_separation), (Some(2.0), Some(1e-9), None));
///
/// let fault = SceneTerms::parse(serde_json::json!({"tolerance": 0})).unwrap_err();
/// assert_eq!(fault.to_string(), "tolerance: 0.0 is not a positive finite distance");
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct SceneTerms {
    /// The times that count.
    pub window: Option<Window>,
    /// Distance at which bodies count as in contact, at least zero.
    pub min_separation: Option<f64>,
    /// The tolerance, a positive distance.
    pub tolerance: Option<f64>,
    /// What counts of bodies that are in contact at the start.
    pub start: Option<Start>,
}

/// The keys as they stand in a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TermsForm {
    #[serde(default)]
    pub(crate) window: Option<Value>,
    #[serde(default)]
    pub(crate) min_separation: Option<Value>,
    #[serde(default)]
    pub(crate) tolerance: Option<Value>,
    #[serde(default)]
    pub(crate) start: Option<Value>,
}

impl SceneTerms {
    /// The keys of a scene's object, which has no others.
    ///
    /// # Errors
    /// [`IoError::Content`] with the key and the value: another type, a window that is reversed, a number out of its range.
    pub fn parse(value: Value) -> Result<Self, IoError> {
        Self::checked(keys_of("", value)?)
    }

    pub(crate) fn checked(form: TermsForm) -> Result<Self, IoError> {
        fn read<T: serde::de::DeserializeOwned>(
            key: &str,
            value: Option<Value>,
        ) -> Result<Option<T>, IoError> {
            value.map(|value| serde_json::from_value(value).map_err(|error| fault(key, error))).transpose()
        }
        let window: Option<[f64; 2]> = read("window", form.window)?;
        let window = window.map(|[start, end]| Window::try_new(start, end));
        let window = window.transpose().map_err(|error| fault("window", error))?;
        let min_separation: Option<f64> = read("min_separation", form.min_separation)?;
        min_separation.map_or(Ok(()), |distance| check_distance("min_separation", distance))?;
        let tolerance: Option<f64> = read("tolerance", form.tolerance)?;
        if let Some(tolerance) = tolerance.filter(|tolerance| !(*tolerance > 0.0 && tolerance.is_finite())) {
            return Err(fault("tolerance", format!("{tolerance:?} is not a positive finite distance")));
        }
        let start = parse_start(form.start.as_ref()).map_err(|reason| fault("start", reason))?;
        Ok(Self { window, min_separation, tolerance, start })
    }
}
