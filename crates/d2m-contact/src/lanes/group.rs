//! All blocks of one kind, in batches.

use super::super::block::Block;
use super::super::solver_body::SolverBody;
use super::Order;
use super::batch::{Batch, Ends, Pushes};
use crate::velocity::Velocity;
use core::ops::Range;
use d2m_lanes::{Doubles, Quad};

/// A block in each lane.
pub(super) trait Side: Clone + Default {
    /// Puts a block into a lane.
    fn put(&mut self, lane: usize, block: &Block);
    fn rates<D: Doubles>(&self, ends: &Ends<D>) -> [D; 3];
    /// The impulses with which blocks obey their laws, at the rates that they have with those of now.
    fn relaxed<D: Doubles>(&self, asked: &Asked, rates: &[D; 3], own: &[D; 3]) -> [D; 3];
    /// The nearest impulses that the laws allow.
    fn projected<D: Doubles>(&self, impulses: &[D; 3]) -> [D; 3];
    /// How far impulses are from what the laws ask for, as rates; see `System::residual`.
    fn natural_map<D: Doubles>(&self, asked: &Asked, rates: &[D; 3], own: &[D; 3]) -> D;
    fn pushes<D: Doubles>(&self, impulses: &[D; 3]) -> Pushes<D>;
}

/// What the block in each lane must reach, whatever its kind; zero where there is none.
#[derive(Clone, Debug, Default)]
pub(super) struct Asked {
    pub(super) scale: Quad,
    pub(super) target: Quad,
    spare: Quad,
}

/// A block in each lane, none at first.
#[derive(Clone, Debug, Default)]
struct Row<S> {
    side: S,
    asked: Asked,
}

/// Blocks of one kind, their impulses, and what sweeps go on along.
#[derive(Clone, Debug)]
pub(super) struct Group<S> {
    batches: Vec<Batch>,
    rows: Vec<Row<S>>,
    /// The blocks' places in the system.
    places: Vec<[Option<usize>; 4]>,
    pub(super) impulses: Vec<[Quad; 3]>,
    /// The impulses before the last sweep forth, the first of two.
    begun: Vec<[Quad; 3]>,
    way: Vec<[Quad; 3]>,
    pub(super) count: usize,
}

/// The numbers of a system that lanes take over.
#[derive(Clone, Copy)]
pub(crate) struct Numbers<'s> {
    pub(crate) bodies: &'s [SolverBody],
    pub(crate) blocks: &'s [Block],
    pub(crate) impulses: &'s [[f64; 3]],
    pub(crate) targets: &'s [f64],
    /// Empty: no flight follows.
    pub(crate) spares: &'s [f64],
}

/// What is left of a group: the largest natural map, the sum of the squares of all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    pub(super) most: f64,
    pub(super) sum: f64,
    pub(super) has_room: bool,
}

/// What sweeps have changed, as energy: the sum of the squares of the impulses' changes, and that of their products with the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    pub(super) square: f64,
    pub(super) along: f64,
}

/// The consecutive blocks of one pair of bodies.
#[derive(Clone, Debug)]
pub(super) struct OfPair {
    bodies: [usize; 2],
    blocks: Range<usize>,
}

/// Layers of pairs of which no two share a body that impulses move: each pair is in the first layer behind those of the pairs before it that
/// share one with it. So layer after layer, forth or back, blocks meet the velocities that they would meet one after the other.
pub(super) fn layers(
    bodies: &[SolverBody],
    blocks: &[Block],
    has_kind: impl Fn(&Block) -> bool,
) -> Vec<Vec<OfPair>> {
    let mut next = vec![0usize; bodies.len()];
    let mut layers: Vec<Vec<OfPair>> = Vec::new();
    let mut end = 0;
    let is_alike =
        |one: &Block, other: &Block| (one.a, one.b, has_kind(one)) == (other.a, other.b, has_kind(other));
    for of_pair in blocks.chunk_by(is_alike) {
        let first = end;
        end += of_pair.len();
        let Some(block) = of_pair.first().filter(|block| has_kind(block)) else { continue };
        let pair = [block.a, block.b];
        let moved = || pair.into_iter().filter(|&body| bodies[body].inverse_mass > 0.0);
        let layer = moved().map(|body| next[body]).max().unwrap_or_default();
        moved().for_each(|body| next[body] = layer + 1);
        layers.resize_with(layers.len().max(layer + 1), Vec::new);
        layers[layer].push(OfPair { bodies: pair, blocks: first..end });
    }
    // Lanes of a batch have about as many blocks.
    for layer in &mut layers {
        layer.sort_by_key(|pair| pair.blocks.len());
    }
    layers
}

impl<S: Side> Group<S> {
    /// Lanes for the blocks of these pairs, without numbers.
    pub(super) fn new(layers: &[Vec<OfPair>]) -> Self {
        let chunks = || layers.iter().flat_map(|layer| layer.chunks(4));
        let most = |pairs: &[OfPair]| pairs.iter().map(|pair| pair.blocks.len()).max().unwrap_or_default();
        let rows = chunks().map(most).sum();
        let mut group = Self {
            batches: Vec::with_capacity(chunks().count()),
            rows: vec![Row::default(); rows],
            places: Vec::with_capacity(rows),
            impulses: vec![[Quad::default(); 3]; rows],
            begun: vec![[Quad::default(); 3]; rows],
            way: vec![[Quad::default(); 3]; rows],
            count: layers.iter().flatten().map(|pair| pair.blocks.len()).sum(),
        };
        for pairs in chunks() {
            let start = group.places.len();
            for row in 0..most(pairs) {
                let place = |lane: usize| pairs.get(lane).and_then(|pair| pair.blocks.clone().nth(row));
                group.places.push([place(0), place(1), place(2), place(3)]);
            }
            let bodies = |lane: usize| pairs.get(lane).map(|pair| pair.bodies);
            let bodies = [bodies(0), bodies(1), bodies(2), bodies(3)];
            group.batches.push(Batch::new(bodies, start..group.places.len()));
        }
        group
    }

    /// These numbers in the lanes of their blocks.
    pub(super) fn fill(&mut self, numbers: Numbers<'_>) {
        for batch in &mut self.batches {
            batch.fill(numbers.bodies);
        }
        for ((places, row), own) in self.places.iter().zip(&mut self.rows).zip(&mut self.impulses) {
            for (lane, place) in places.iter().enumerate() {
                let Some(k) = *place else { continue };
                let spare = numbers.spares.get(k).copied().unwrap_or(f64::INFINITY);
                row.side.put(lane, &numbers.blocks[k]);
                let Asked { scale, target, spare: room } = &mut row.asked;
                scale.0[lane] = numbers.blocks[k].scale;
                (target.0[lane], room.0[lane]) = (numbers.targets[k], spare);
                for (quad, impulse) in own.iter_mut().zip(numbers.impulses[k]) {
                    quad.0[lane] = impulse;
                }
            }
        }
    }

    pub(super) fn write(&self, impulses: &mut [[f64; 3]]) {
        for (places, own) in self.places.iter().zip(&self.impulses) {
            for (lane, place) in places.iter().enumerate() {
                if let Some(k) = *place {
                    impulses[k] = [own[0].0[lane], own[1].0[lane], own[2].0[lane]];
                }
            }
        }
    }

    #[inline(always)]
    pub(super) fn sweep<D: Doubles>(&mut self, velocities: &mut [Velocity], order: Order) {
        for n in 0..self.batches.len() {
            let batch = &self.batches[if order == Order::Forth { n } else { self.batches.len() - 1 - n }];
            let mut ends = batch.load::<D>(velocities);
            for m in 0..batch.rows.len() {
                let k = if order == Order::Forth { batch.rows.start + m } else { batch.rows.end - 1 - m };
                let (Row { side, asked }, own) = (&self.rows[k], load::<D>(&self.impulses[k]));
                if order == Order::Forth {
                    self.begun[k] = self.impulses[k];
                }
                let wanted = side.relaxed(asked, &side.rates(&ends), &own);
                batch.push(&mut ends, &side.pushes(&minus(&wanted, &own)));
                self.impulses[k] = store(&wanted);
            }
            batch.store(&ends, velocities);
        }
    }

    #[inline(always)]
    pub(super) fn off<D: Doubles>(&self, velocities: &[Velocity]) -> Left {
        let zero = D::splat(0.0);
        let (mut most, mut sum, mut lacks) = (zero, zero, zero);
        for batch in &self.batches {
            let ends = batch.load::<D>(velocities);
            for k in batch.rows.start..batch.rows.end {
                let Row { side, asked } = &self.rows[k];
                let rates = side.rates(&ends);
                let off = side.natural_map(asked, &rates, &load(&self.impulses[k]));
                let off = D::if_greater(D::load(&asked.scale), zero, off, zero);
                most = most.max(off);
                sum = sum + off * off;
                let below = D::load(&asked.target) - rates[0];
                lacks = D::if_greater(below, D::load(&asked.spare), D::splat(1.0), lacks);
            }
        }
        Left { most: most.max_element(), sum: total(sum), has_room: lacks.max_element() == 0.0 }
    }

    /// What sweeps have changed is the way to go on.
    pub(super) fn begin_way(&mut self) {
        core::mem::swap(&mut self.way, &mut self.begun);
    }

    /// Takes what sweeps have changed in place of what they began with.
    #[inline(always)]
    pub(super) fn changed<D: Doubles>(&mut self) -> Change {
        let (mut square, mut along) = (D::splat(0.0), D::splat(0.0));
        for k in 0..self.rows.len() {
            let change = minus(&load::<D>(&self.impulses[k]), &load(&self.begun[k]));
            let scale = D::load(&self.rows[k].asked.scale);
            square = square + scale * dot(&change, &change);
            along = along + scale * dot(&change, &load(&self.way[k]));
            self.begun[k] = store(&change);
        }
        Change { square: total(square), along: total(along) }
    }

    /// Goes on along a part of the way, and adds to that part what sweeps have changed.
    #[inline(always)]
    pub(super) fn go_on<D: Doubles>(&mut self, velocities: &mut [Velocity], part: f64) {
        let part = D::splat(part);
        for batch in &self.batches {
            let mut ends = batch.load::<D>(velocities);
            for k in batch.rows.start..batch.rows.end {
                let (Row { side, .. }, own) = (&self.rows[k], load::<D>(&self.impulses[k]));
                let [n, t, u] = load::<D>(&self.way[k]);
                let along = [n * part, t * part, u * part];
                let further = side.projected(&plus(&own, &along));
                batch.push(&mut ends, &side.pushes(&minus(&further, &own)));
                self.impulses[k] = store(&further);
                self.way[k] = store(&plus(&along, &load(&self.begun[k])));
            }
            batch.store(&ends, velocities);
        }
    }
}

#[inline(always)]
fn load<D: Doubles>(values: &[Quad; 3]) -> [D; 3] {
    [D::load(&values[0]), D::load(&values[1]), D::load(&values[2])]
}

#[inline(always)]
fn store<D: Doubles>(values: &[D; 3]) -> [Quad; 3] {
    [values[0].store(), values[1].store(), values[2].store()]
}

#[inline(always)]
fn minus<D: Doubles>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn plus<D: Doubles>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn dot<D: Doubles>(a: &[D; 3], b: &[D; 3]) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The sum of all lanes.
#[inline(always)]
fn total<D: Doubles>(values: D) -> f64 {
    let Quad([a, b, c, d]) = values.store();
    (a + b) + (c + d)
}
