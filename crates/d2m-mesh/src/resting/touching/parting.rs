//! The direction along which bodies that touch part, and the proof that they do.
//!
//! Nothing is proven by the choice of a direction: the body B, moved along it by a few roundings, is proven apart from A, or the direction is
//! dropped. Of directions that part the one is wanted that is normal to the features that touch.

use super::axis::{Axis, TouchingPair};
use super::{FIRST_STEP, LAST_STEP};
use crate::meter::{Exhausted, Meter};
use crate::nearest_point::Simplex;
use glam::DVec3;

/// Axes kept as different, at most.
const MOST_AXES: usize = 64;
/// Different axes of which sums are tried, at most, and sums that are.
const MOST_MIXED: usize = 16;
const MOST_TRIED: usize = 4;
/// Rounds in which axes are added that a direction has to follow.
const MOST_ROUNDS: usize = 32;
/// A direction parts two triangles if it leaves the plane between them by more than this sine: the first step along it is
/// [`FIRST_STEP`] divided by the sine, and none is longer than [`LAST_STEP`].
pub(super) const LEAST_RISE: f64 = FIRST_STEP / LAST_STEP;
/// Axes with blurs up to this factor of the least one are as good.
const AS_GOOD: f64 = 16.0;

/// Directions from A to B that part all pairs to first order.
pub(super) struct Directions {
    /// Best first.
    pub(super) found: Vec<DVec3>,
    /// Does no plane part all? Then [`mixtures`] may be of use.
    pub(super) several: bool,
}

/// Those that are found at once.
///
/// # Errors
/// [`Exhausted`]: the time is over.
pub(super) fn directions(
    pairs: &[TouchingPair],
    need: f64,
    meter: &mut Meter,
) -> Result<Directions, Exhausted> {
    let common = common_axes(pairs, need, meter)?;
    // The middle of the cone of directions normal to planes between all of A and all of B, near the contacts.
    let middle = common.iter().fold(DVec3::ZERO, |sum, axis| sum + axis.direction).try_normalize();
    let several = common.is_empty();
    let of_several = if several { direction_of_several(pairs, meter)? } else { None };
    let found = middle.into_iter().chain(common.into_iter().map(|axis| axis.direction)).chain(of_several);
    Ok(Directions { found: found.collect(), several })
}

/// Axes along which no pair overlaps.
fn common_axes(pairs: &[TouchingPair], need: f64, meter: &mut Meter) -> Result<Vec<Axis>, Exhausted> {
    let mut all: Vec<Axis> = Vec::new();
    // An axis that all share is among those of each.
    let Some(first) = pairs.iter().min_by_key(|pair| pair.axes.len()) else { return Ok(all) };
    let mut shared = |axis: &Axis| {
        meter.read_clock()?;
        Ok(pairs.iter().all(|pair| pair.fits(axis, need)))
    };
    for axis in &first.axes {
        if shared(axis)? {
            add(&mut all, axis);
        }
    }
    // The cone that all share may be narrower than that of one: its rays are across edges of any pair.
    for axis in pairs.iter().flat_map(|pair| &pair.axes) {
        if all.len() < MOST_AXES && !all.iter().any(|one| one.is_same(axis)) && shared(axis)? {
            all.push(*axis);
        }
    }
    let least = all.iter().map(|axis| axis.blur).fold(f64::INFINITY, f64::min);
    all.retain(|axis| axis.blur <= AS_GOOD * least);
    Ok(all)
}

/// With this axis, or the better one of the two if it is there.
fn add(all: &mut Vec<Axis>, axis: &Axis) {
    match all.iter_mut().find(|one| one.is_same(axis)) {
        Some(one) if axis.blur < one.blur => *one = *axis,
        Some(_) => {}
        None => all.push(*axis),
    }
}

/// Where no plane parts all: the direction that rises from the plane between each pair, as steeply as possible from the one from which it
/// rises least.
fn direction_of_several(pairs: &[TouchingPair], meter: &mut Meter) -> Result<Option<DVec3>, Exhausted> {
    let mut of_one: Vec<Axis> = Vec::new();
    for pair in pairs {
        if let Some((only, others)) = pair.axes.split_first()
            && others.iter().all(|axis| axis.is_same(only))
        {
            add(&mut of_one, only);
        }
    }
    let mut needed: Vec<DVec3> = of_one.iter().map(|axis| axis.direction).collect();
    if needed.is_empty() {
        needed.extend(pairs.first().and_then(|pair| pair.axes.first()).map(|axis| axis.direction));
    }
    for _ in 0..MOST_ROUNDS {
        meter.read_clock()?;
        let Some(n) = steepest(&needed) else { return Ok(None) };
        let rise = |pair: &&TouchingPair| steepest_rise(pair, n);
        let Some(worst) = pairs.iter().min_by(|x, y| rise(x).total_cmp(&rise(y))) else { return Ok(None) };
        if rise(&worst) > LEAST_RISE {
            return Ok(Some(n));
        }
        let rises = |axis: &&Axis| axis.direction.dot(n);
        let Some(best) = worst.axes.iter().max_by(|x, y| rises(x).total_cmp(&rises(y))) else {
            return Ok(None);
        };
        needed.push(best.direction);
    }
    Ok(None)
}

/// Where a pair may part along one of several axes, the direction that rises steeply from one of each need not be near those that
/// rise most from the pairs before: sums of up to three axes of the pairs, the steepest first.
///
/// # Errors
/// [`Exhausted`]: the time is over.
pub(super) fn mixtures(pairs: &[TouchingPair], meter: &mut Meter) -> Result<Vec<DVec3>, Exhausted> {
    let mut axes: Vec<Axis> = Vec::new();
    for axis in pairs.iter().flat_map(|pair| &pair.axes) {
        if axes.len() < MOST_MIXED || axes.iter().any(|one| one.is_same(axis)) {
            add(&mut axes, axis);
        }
    }
    let mut found: Vec<(f64, DVec3)> = Vec::new();
    let mut consider = |sum: DVec3| {
        let Some(n) = sum.try_normalize() else { return Ok(()) };
        meter.read_clock()?;
        let mut rise = f64::INFINITY;
        for pair in pairs {
            rise = rise.min(steepest_rise(pair, n));
            if rise <= LEAST_RISE {
                return Ok(());
            }
        }
        found.push((rise, n));
        Ok(())
    };
    let at = |k: usize| axes[k].direction;
    for i in 0..axes.len() {
        consider(at(i))?;
        for j in 0..i {
            consider(at(i) + at(j))?;
            (0..j).try_for_each(|k| consider(at(i) + at(j) + at(k)))?;
        }
    }
    found.sort_by(|x, y| y.0.total_cmp(&x.0));
    found.truncate(MOST_TRIED);
    Ok(found.into_iter().map(|(_, n)| n).collect())
}

/// How steeply the direction rises from the plane between two triangles that it leaves best: a sine.
pub(super) fn steepest_rise(pair: &TouchingPair, n: DVec3) -> f64 {
    pair.axes.iter().map(|axis| axis.direction.dot(n)).fold(f64::NEG_INFINITY, f64::max)
}

/// The unit direction whose least product with some unit directions is greatest: that of the point of their hull that is nearest to the
/// origin. `None`: that hull holds the origin.
fn steepest(directions: &[DVec3]) -> Option<DVec3> {
    let least = |n: DVec3| directions.iter().copied().min_by(|p, q| n.dot(*p).total_cmp(&n.dot(*q)));
    let mut simplex = Simplex::new(*directions.first()?);
    for _ in 0..MOST_ROUNDS {
        let Some(next) = simplex.with(least(simplex.nearest())?) else { break };
        simplex = next;
    }
    let nearest = simplex.nearest();
    (nearest.length() > LEAST_RISE).then(|| nearest.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Budget, Canceller};

    /// Nothing is sought when the time is over: thousands of pairs of triangles that touch would take a second.
    #[test]
    fn directions_are_sought_for_as_long_as_there_is_time() {
        let canceller = Canceller::new();
        let mut meter = Meter::new(&Budget::UNLIMITED.with_cancel(canceller.flag()));
        let pairs = [TouchingPair::along(&[DVec3::X, DVec3::Y])];
        assert!(!directions(&pairs, 1e-12, &mut meter).unwrap().found.is_empty());
        assert!(!mixtures(&pairs, &mut meter).unwrap().is_empty());
        canceller.cancel();
        assert!(directions(&pairs, 1e-12, &mut meter).is_err());
        assert!(mixtures(&pairs, &mut meter).is_err());
        assert!(direction_of_several(&pairs, &mut meter).is_err());
    }
}
