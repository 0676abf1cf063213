//! Targets of a run, beside what it took.

/// What a run took as a whole.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Took {
    pub(super) simulated: f64,
    /// Seconds of the processor, where the system reports them.
    pub(super) processor: Option<f64>,
    /// Simulated seconds for each second of the processor at the end of the run.
    pub(super) settled: Option<f64>,
}

/// A bound of our figures; seconds are those of the processor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bound {
    /// Of the whole run, at most.
    Seconds(f64),
    /// For each simulated second, at most.
    SecondsPerSimulated(f64),
    /// As a part of what rapier takes for the same scene, at most.
    OfRapier(f64),
    /// Simulated seconds a second at the end of the run, at least.
    SettledRealTime(f64),
}

impl Bound {
    /// The figure beside its target, and whether that is met; unknown if the system or the peer gives none.
    pub(super) fn judged(self, run: &Took, peer: Option<&Took>) -> String {
        let (figure, limit, unit, sign) = match self {
            Self::Seconds(limit) => (run.processor, limit, "s of CPU", '≤'),
            Self::SecondsPerSimulated(limit) => {
                (run.processor.map(|s| s / run.simulated), limit, "s of CPU a simulated second", '≤')
            }
            Self::OfRapier(limit) => {
                let ratio = run.processor.zip(peer.and_then(|peer| peer.processor)).map(|(a, b)| a / b);
                (ratio, limit, "of rapier's CPU", '≤')
            }
            Self::SettledRealTime(limit) => (run.settled, limit, "× real time once settled", '≥'),
        };
        let Some(figure) = figure else { return format!("unknown (asked: {sign} {limit}) {unit}") };
        let is_met = if sign == '≤' { figure <= limit } else { figure >= limit };
        format!("{figure:.3} (asked: {sign} {limit}) {unit}: {}", if is_met { "met" } else { "missed" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_stand_beside_what_is_asked() {
        let run = |processor| Took { simulated: 4.0, processor: Some(processor), settled: Some(30.0) };
        let (ours, theirs) = (run(2.0), run(3.0));
        let words = |bound: Bound| bound.judged(&ours, Some(&theirs));
        assert_eq!(words(Bound::Seconds(2.0)), "2.000 (asked: ≤ 2) s of CPU: met");
        assert_eq!(
            words(Bound::SecondsPerSimulated(0.01)),
            "0.500 (asked: ≤ 0.01) s of CPU a simulated second: missed"
        );
        assert_eq!(words(Bound::OfRapier(0.5)), "0.667 (asked: ≤ 0.5) of rapier's CPU: missed");
        assert_eq!(words(Bound::SettledRealTime(20.0)), "30.000 (asked: ≥ 20) × real time once settled: met");
        assert_eq!(Bound::OfRapier(0.5).judged(&ours, None), "unknown (asked: ≤ 0.5) of rapier's CPU");
    }
}
