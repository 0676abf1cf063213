//! One answered and judged question, and its line in a file.
use crate::judge::Claim;

/// A line of a result file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    pub(crate) trial: usize,
    pub(crate) claim: Claim,
    /// Left at `lo`, by the judge; infinite when there is no contact.
    pub(crate) separation: f64,
    /// The same by parry; NaN where it was not asked.
    pub(crate) parry_separation: f64,
    /// The least of the rounds; for a query that was stopped, the time after which it was.
    pub(crate) microseconds: f64,
    /// What is wrong; empty if nothing.
    pub(crate) fault: String,
}

pub(crate) const HEADER: &str = "trial,status,lo,hi,tolerance,separation,parry_separation,microseconds,fault";

impl Row {
    /// The row of a claim with what the judge says of it: the separation left, or what is wrong.
    pub(crate) fn judged(
        trial: usize,
        claim: Claim,
        microseconds: f64,
        verdict: Result<f64, impl std::fmt::Display>,
    ) -> Self {
        let (separation, fault) = match verdict {
            Ok(separation) => (separation, String::new()),
            Err(fault) => (f64::INFINITY, fault.to_string()),
        };
        Self { trial, claim, separation, parry_separation: f64::NAN, microseconds, fault }
    }

    pub(crate) fn line(&self) -> String {
        let (status, lo, hi, tolerance) = match self.claim {
            Claim::Separated => ("separated", f64::INFINITY, f64::INFINITY, 0.0),
            Claim::Contact { lo, hi, tolerance } => ("contact", lo, hi, tolerance),
            Claim::Undecided { clear_until } => ("undecided", clear_until, f64::INFINITY, 0.0),
        };
        let Self { trial, separation, parry_separation, microseconds, fault, .. } = self;
        format!(
            "{trial},{status},{lo:?},{hi:?},{tolerance:?},{separation:?},{parry_separation:?},{microseconds:.3},{}",
            fault.replace([',', '\n'], ";")
        )
    }

    pub(crate) fn parse(line: &str) -> Option<Self> {
        let mut fields = line.split(',');
        let trial = fields.next()?.parse().ok()?;
        let status = fields.next()?;
        let mut number = || fields.next()?.parse::<f64>().ok();
        let (lo, hi, tolerance) = (number()?, number()?, number()?);
        let claim = match status {
            "separated" => Claim::Separated,
            "contact" => Claim::Contact { lo, hi, tolerance },
            "undecided" => Claim::Undecided { clear_until: lo },
            _ => return None,
        };
        let (separation, parry_separation, microseconds) = (number()?, number()?, number()?);
        Some(Self { trial, claim, separation, parry_separation, microseconds, fault: fields.next()?.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_gives_the_row_back() {
        let contact = Claim::Contact { lo: 0.1, hi: 0.1 + 1e-16, tolerance: 1e-10 };
        for claim in [contact, Claim::Separated, Claim::Undecided { clear_until: 1.0 / 3.0 }] {
            let fault = "late; by a lot".to_string();
            let row = Row {
                trial: 7,
                claim,
                separation: 1e-10,
                parry_separation: 2e-10,
                microseconds: 12.5,
                fault,
            };
            assert_eq!(Row::parse(&row.line()), Some(row));
        }
        assert_eq!(Row::parse("1,nonsense,0,0,0,0,0,0,"), None);
        assert_eq!(Row::parse("1,contact,0"), None);
    }
}
