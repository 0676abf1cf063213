/// A scale from numbers to pixels.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    /// What is measured, with its unit.
    pub(crate) label: String,
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    logarithmic: bool,
    /// Marked at whole numbers only.
    whole: bool,
    /// The lowest mark of a logarithmic axis stands for 0.
    zero: bool,
}

impl Axis {
    /// Logarithmic, over whole decades that hold all positive finite numbers given.
    pub(crate) fn decades(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let (mut lo, mut hi) = (f64::INFINITY, 0.0f64);
        for value in values.into_iter().filter(|v| v.is_finite() && *v > 0.0) {
            lo = lo.min(value);
            hi = hi.max(value);
        }
        if hi <= 0.0 {
            (lo, hi) = (1.0, 10.0);
        }
        // A hair inside the decade counts as the decade, so that 1e-10·(1 − 1e-12) does not open another one.
        let lo = 10f64.powf((lo.log10() + 1e-6).floor());
        let hi = 10f64.powf((hi.log10() - 1e-6).ceil());
        Self {
            label: label.into(),
            lo,
            hi: if hi <= lo { lo * 10.0 } else { hi },
            logarithmic: true,
            whole: false,
            zero: false,
        }
    }

    /// The same, with a decade more for 0 if that is among the numbers.
    pub(crate) fn decades_and_zero(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        let zero = values.contains(&0.0);
        let axis = Self::decades(label, values);
        Self { lo: if zero { axis.lo / 10.0 } else { axis.lo }, zero, ..axis }
    }

    /// Linear, from 0 to a round number not below the largest.
    pub(crate) fn linear(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let most = values.into_iter().filter(|v| v.is_finite()).fold(1e-300, f64::max);
        let step = round_step(most / 5.0);
        Self {
            label: label.into(),
            lo: 0.0,
            hi: (most / step).ceil() * step,
            logarithmic: false,
            whole: false,
            zero: false,
        }
    }

    /// Linear from 0 to a whole number above the largest, marked at whole numbers only.
    pub(crate) fn counts(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let most = values.into_iter().filter(|v| v.is_finite()).fold(1.0, f64::max);
        Self {
            label: label.into(),
            lo: 0.0,
            hi: most.ceil() + 1.0,
            logarithmic: false,
            whole: true,
            zero: false,
        }
    }

    /// 0 at `lo`, 1 at `hi`; clamped, so that nothing is drawn outside.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let part = if self.logarithmic {
            (value.max(self.lo) / self.lo).log10() / (self.hi / self.lo).log10()
        } else {
            (value - self.lo) / (self.hi - self.lo)
        };
        part.clamp(0.0, 1.0)
    }

    /// Places and labels of the marks: every decade, or every second, third … when there are many.
    pub(crate) fn ticks(&self) -> Vec<(f64, String)> {
        if !self.logarithmic {
            let step = round_step((self.hi - self.lo) / 5.0).max(if self.whole { 1.0 } else { 0.0 });
            let count = ((self.hi - self.lo) / step + 1e-9) as usize;
            return (0..=count).map(|k| self.lo + k as f64 * step).map(|v| (v, plain(v))).collect();
        }
        if self.zero {
            let rest = Self { lo: 10.0 * self.lo, zero: false, ..self.clone() };
            return std::iter::once((self.lo, "0".into())).chain(rest.ticks()).collect();
        }
        let (first, last) = (self.lo.log10().round() as i32, self.hi.log10().round() as i32);
        if last - first <= 2 {
            // Few decades: also twice and five times.
            let between = |e: i32| [1.0, 2.0, 5.0].map(|m| (m * 10f64.powi(e), multiple(m as i32, e)));
            let all = (first..=last).flat_map(between);
            return all.filter(|(v, _)| *v <= self.hi * (1.0 + 1e-9)).collect();
        }
        let every = ((last - first) / 9 + 1) as usize;
        (first..=last).step_by(every).map(|e| (10f64.powi(e), decade(e))).collect()
    }
}

/// 1, 2 or 5 times a power of ten, not below the wish.
fn round_step(wish: f64) -> f64 {
    let power = 10f64.powf(wish.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&s| s >= wish * (1.0 - 1e-9)).unwrap_or(wish)
}

/// 10⁻¹⁰, 2·10⁻¹⁰, 0.5, 20.
fn multiple(m: i32, e: i32) -> String {
    match m {
        1 => decade(e),
        _ if (-3..=4).contains(&e) => plain(f64::from(m) * 10f64.powi(e)),
        _ => format!("{m}·{}", decade(e)),
    }
}

/// 0.01, 1, 1000, and 10⁻⁵ or 10⁶ beyond.
fn decade(e: i32) -> String {
    if (-3..=4).contains(&e) {
        return plain(10f64.powi(e));
    }
    let digits: String = e.abs().to_string().chars().map(superscript).collect();
    format!("10{}{digits}", if e < 0 { "⁻" } else { "" })
}

fn superscript(digit: char) -> char {
    ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize - '0' as usize]
}

/// Without trailing zeros of a rounding.
fn plain(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text.is_empty() { "0".into() } else { text.into() }
}
