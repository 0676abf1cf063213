//! Why a shape's text was refused.

use thiserror::Error;

/// A shape that does not exist or a parameter that it cannot have.
///
/// ```
/// use d2m_shapes::ShapeError;
/// let refused = d2m_shapes::mesh("gear?tooth=24").unwrap_err();
/// assert!(matches!(&refused, ShapeError::UnknownParameter { shape: "gear", name, .. } if name == "tooth"));
/// assert!(refused.to_string().starts_with("shape gear: there is no parameter \"tooth\"; it has "));
/// ```
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// No shape has this name.
    #[error("there is no shape {name:?}; {hint}shapes are {known}", hint = .meant.map(|shape| format!("is {shape} meant? ")).unwrap_or_default())]
    UnknownShape {
        /// The name that was given.
        name: String,
        /// The shape that was probably meant: under another of its names, or misspelled.
        meant: Option<&'static str>,
        /// All names, comma-separated.
        known: String,
    },
    /// The shape has no such parameter.
    #[error("shape {shape}: there is no parameter {name:?}; it has {known}")]
    UnknownParameter {
        /// The shape.
        shape: &'static str,
        /// The parameter that was given.
        name: String,
        /// All parameters, comma-separated.
        known: String,
    },
    /// A parameter without a value.
    #[error("shape {shape}: {text:?} should be parameter=value")]
    MissingValue {
        /// The shape.
        shape: &'static str,
        /// The text found.
        text: String,
    },
    /// A parameter was given more than once.
    #[error("shape {shape}: {name} is given twice")]
    GivenTwice {
        /// The shape.
        shape: &'static str,
        /// The parameter.
        name: &'static str,
    },
    /// A value that is not a number.
    #[error("shape {shape}: {name}={text} is not a number")]
    NotANumber {
        /// The shape.
        shape: &'static str,
        /// The parameter.
        name: &'static str,
        /// The text found.
        text: String,
    },
    /// A number outside the parameter's range.
    #[error("shape {shape}: {name}={value:?} is out of range, it must be {whole}from {low} to {high}", whole = if *.integer { "a whole number " } else { "" })]
    OutOfRange {
        /// The shape.
        shape: &'static str,
        /// The parameter.
        name: &'static str,
        /// The value found.
        value: f64,
        /// Smallest value.
        low: f64,
        /// Largest value.
        high: f64,
        /// Whether the parameter is a count.
        integer: bool,
    },
    /// Two parameters that do not go together.
    #[error("shape {shape}: {reason}")]
    Conflict {
        /// The shape.
        shape: &'static str,
        /// What does not fit.
        reason: String,
    },
}
