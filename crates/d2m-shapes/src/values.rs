//! What a builder knows of its shape.

/// The values that builders look up; every name is one of the shape's own.
pub(crate) struct Values(pub(crate) Vec<(&'static str, f64)>);

impl Values {
    pub(crate) fn get(&self, name: &str) -> f64 {
        let found = self.0.iter().find(|(own, _)| *own == name);
        found.expect("builders ask for parameters of their own shape").1
    }

    pub(crate) fn count(&self, name: &str) -> usize {
        self.get(name) as usize
    }
}
