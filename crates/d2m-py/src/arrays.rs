//! Arrays of any numbers in, checked; no copy of what is C-contiguous doubles already.

use crate::fault::{Fault, Value};
use numpy::{
    Element, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Doubles in C order, of a shape that was asked for.
pub(crate) struct Doubles<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
}

impl<'py> Doubles<'py> {
    /// From an array or nested sequences. `shape`: the number of elements a dimension has, or `None` for any.
    ///
    /// # Errors
    /// Another shape; what are no numbers; whole numbers that are no doubles, with index and value.
    pub(crate) fn new(any: &Bound<'py, PyAny>, name: &str, shape: &[Option<usize>]) -> PyResult<Self> {
        if let Some(array) = Self::ready(any) {
            require_shape(array.shape(), name, shape)?;
            return Ok(array);
        }
        let array = as_array(any, name)?;
        require_shape(&shape_of(&array)?, name, shape)?;
        Self::of_array(&array, name)
    }

    /// As [`Self::new`] with any shape.
    pub(crate) fn of_any_shape(any: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        match Self::ready(any) {
            Some(array) => Ok(array),
            None => Self::of_array(&as_array(any, name)?, name),
        }
    }

    /// What is such an array already, without a call of Python: a query of a few numbers takes less than one.
    fn ready(any: &Bound<'py, PyAny>) -> Option<Self> {
        let array = any.cast::<PyArrayDyn<f64>>().ok()?;
        // Subclasses, as arrays with a mask, go through `as_array`, which refuses masked elements.
        let is_plain = any.get_type().is(any.py().get_type::<PyUntypedArray>());
        if !(is_plain && array.is_c_contiguous() && array.data().is_aligned()) {
            return None;
        }
        Some(Self { array: array.try_readonly().ok()? })
    }

    fn of_array(array: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        let py = array.py();
        let dtype = array.getattr(intern!(py, "dtype"))?;
        let kind: char = dtype.getattr(intern!(py, "kind"))?.extract()?;
        if !matches!(kind, 'f' | 'i' | 'u') {
            return Err(wrong_dtype(&dtype, name, "numbers"));
        }
        let doubles = contiguous(array, "float64")?;
        let size: usize = dtype.getattr(intern!(py, "itemsize"))?.extract()?;
        if kind != 'f' && size >= 8 {
            require_same(array, &doubles, name)?;
        }
        let doubles = doubles.cast_into::<PyArrayDyn<f64>>()?;
        let array = doubles.try_readonly().map_err(|error| Fault::new(format!("{name}: {error}")))?;
        array.as_slice().map_err(|error| Fault::new(format!("{name}: {error}")))?;
        Ok(Self { array })
    }

    /// The numbers in C order.
    pub(crate) fn slice(&self) -> &[f64] {
        // Checked when it was made.
        self.array.as_slice().unwrap_or_default()
    }

    /// The shape.
    pub(crate) fn shape(&self) -> &[usize] {
        self.array.shape()
    }

    /// The first number that is not finite, as a fault with its place.
    pub(crate) fn require_finite(&self, name: &str) -> Result<(), Fault> {
        match self.slice().iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(place) => {
                let value = self.slice()[place];
                let places = places_of(place, self.shape());
                let at: Vec<String> = places.iter().map(ToString::to_string).collect();
                let message = format!("{name}[{}] is {value}, not a finite number", at.join(", "));
                Err(Fault::new(message).at_places(places).found(value))
            }
        }
    }
}

/// Where the n-th element in C order is.
fn places_of(mut place: usize, shape: &[usize]) -> Vec<usize> {
    let mut places: Vec<usize> = shape
        .iter()
        .rev()
        .map(|&length| {
            let here = place % length.max(1);
            place /= length.max(1);
            here
        })
        .collect();
    places.reverse();
    places
}

fn numpy<'py>(py: Python<'py>) -> PyResult<Bound<'py, PyModule>> {
    py.import(intern!(py, "numpy"))
}

/// `numpy.asarray`, whose complaints become faults.
fn as_array<'py>(any: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = any.py();
    if any.is_none() {
        return Err(PyTypeError::new_err(format!("{name} is None: an array of numbers is expected")));
    }
    // Numbers behind a mask are none.
    if any.hasattr(intern!(py, "mask"))? {
        let masked = numpy(py)?.getattr(intern!(py, "ma"))?.call_method1(intern!(py, "is_masked"), (any,))?;
        if masked.is_truthy()? {
            return Err(Fault::new(format!("{name} has masked elements, numbers are expected")).into());
        }
    }
    let array = numpy(py)?.call_method1(intern!(py, "asarray"), (any,));
    array.map_err(|error| Fault::new(format!("{name} is not an array: {}", error.value(py))).into())
}

fn contiguous<'py>(array: &Bound<'py, PyAny>, dtype: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = array.py();
    let keywords = PyDict::new(py);
    keywords.set_item("dtype", dtype)?;
    keywords.set_item("requirements", ["C_CONTIGUOUS", "ALIGNED"])?;
    numpy(py)?.call_method(intern!(py, "require"), (array,), Some(&keywords))
}

fn wrong_dtype(dtype: &Bound<'_, PyAny>, name: &str, wanted: &str) -> PyErr {
    let fault = Fault::new(format!("{name} has the dtype {dtype}, {wanted} are expected"));
    fault.with_value(Value::Text(dtype.to_string())).into()
}

fn shape_of(array: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
    array.getattr(intern!(array.py(), "shape"))?.extract()
}

fn require_shape(found: &[usize], name: &str, wanted: &[Option<usize>]) -> PyResult<()> {
    let fits = found.len() == wanted.len()
        && found.iter().zip(wanted).all(|(&found, wanted)| wanted.is_none_or(|wanted| wanted == found));
    if fits {
        return Ok(());
    }
    let value = Value::Numbers(found.iter().map(|&length| length as f64).collect());
    let message = format!("{name} has the shape {}, {} is expected", shape_text(found), wanted_text(wanted));
    Err(Fault::new(message).with_value(value).into())
}

fn shape_text(shape: &[usize]) -> String {
    let lengths: Vec<String> = shape.iter().map(ToString::to_string).collect();
    format!("({})", lengths.join(", "))
}

fn wanted_text(shape: &[Option<usize>]) -> String {
    let names = ["n", "k", "j"];
    let length = |(place, wanted): (usize, &Option<usize>)| match wanted {
        Some(length) => length.to_string(),
        None => names.get(place).copied().unwrap_or("m").to_owned(),
    };
    let lengths: Vec<String> = shape.iter().enumerate().map(length).collect();
    format!("({})", lengths.join(", "))
}

/// Whole numbers beyond 2⁵³ that were rounded would be another body.
fn require_same(array: &Bound<'_, PyAny>, doubles: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    let py = array.py();
    let module = numpy(py)?;
    let dtype = array.getattr(intern!(py, "dtype"))?;
    let magnitude = module.call_method1(intern!(py, "abs"), (doubles,))?;
    let large = magnitude.call_method1(intern!(py, "__ge__"), (9_007_199_254_740_992.0_f64,))?;
    if !large.call_method0(intern!(py, "any"))?.extract::<bool>()? {
        return Ok(());
    }
    let places = module.call_method1(intern!(py, "argwhere"), (&large,))?;
    let first: Vec<usize> = places.get_item(0)?.extract()?;
    let value: i128 =
        array.get_item(pyo3::types::PyTuple::new(py, &first)?)?.call_method0("item")?.extract()?;
    let message =
        format!("{name}{first:?} is {value} ({dtype}), 2^53 or beyond: not every such number is a double");
    Err(Fault::new(message).at_places(first).with_value(Value::Whole(value)).into())
}

/// Triples of vertex numbers, of any whole type.
///
/// # Errors
/// Another shape or dtype, negative numbers and those that need more than 32 bits, with index and value.
pub(crate) fn triangles(any: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<[u32; 3]>> {
    let py = any.py();
    let array = as_array(any, name)?;
    let dtype = array.getattr(intern!(py, "dtype"))?;
    let kind: char = dtype.getattr(intern!(py, "kind"))?.extract()?;
    let shape = shape_of(&array)?;
    if shape.first() == Some(&0) {
        return Ok(Vec::new());
    }
    if !matches!(kind, 'i' | 'u') {
        return Err(wrong_dtype(&dtype, name, "whole numbers"));
    }
    require_shape(&shape, name, &[None, Some(3)])?;
    let bad = |place: usize, value: i128| -> PyErr {
        let message =
            format!("triangle {}: vertex index {value} is out of range, it must be in [0, 2^32)", place / 3);
        Fault::new(message).at_places(vec![place / 3, place % 3]).with_value(Value::Whole(value)).into()
    };
    if kind == 'u' {
        numbers::<u64>(
            &array,
            "uint64",
            |value| u32::try_from(value).ok(),
            |place, value| bad(place, i128::from(value)),
        )
    } else {
        numbers::<i64>(
            &array,
            "int64",
            |value| u32::try_from(value).ok(),
            |place, value| bad(place, i128::from(value)),
        )
    }
}

fn numbers<T: Element + Copy>(
    array: &Bound<'_, PyAny>,
    dtype: &str,
    narrow: impl Fn(T) -> Option<u32>,
    bad: impl Fn(usize, T) -> PyErr,
) -> PyResult<Vec<[u32; 3]>> {
    let wide = contiguous(array, dtype)?.cast_into::<PyArrayDyn<T>>()?;
    let wide = wide.readonly();
    let wide = wide.as_slice().map_err(|error| Fault::new(error.to_string()))?;
    let narrowed = |(place, &value): (usize, &T)| narrow(value).ok_or_else(|| bad(place, value));
    let flat = wide.iter().enumerate().map(narrowed).collect::<PyResult<Vec<u32>>>()?;
    Ok(flat.as_chunks::<3>().0.to_vec())
}

/// A vector or quaternion of N finite numbers.
///
/// # Errors
/// Another number of elements, no numbers, or one that is not finite, with index and value.
pub(crate) fn small<const N: usize>(any: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; N]> {
    let numbers: [f64; N] = match any.extract() {
        Ok(numbers) => numbers,
        Err(_) => {
            let doubles = Doubles::new(any, name, &[Some(N)])?;
            let mut numbers = [0.0; N];
            numbers.copy_from_slice(doubles.slice());
            numbers
        }
    };
    match numbers.iter().position(|value| !value.is_finite()) {
        None => Ok(numbers),
        Some(index) => {
            let value = numbers[index];
            let message = format!("{name}[{index}] is {value}, not a finite number");
            Err(Fault::new(message).at(index).found(value).into())
        }
    }
}

/// A vector or quaternion for Python.
pub(crate) fn vector<'py>(py: Python<'py>, numbers: &[f64]) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, numbers)
}

/// Rows of N numbers for Python.
pub(crate) fn rows<'py, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.flatten().collect()).reshape([count, N])
}
