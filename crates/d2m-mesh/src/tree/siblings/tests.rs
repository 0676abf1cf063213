use super::{Rows, Siblings, StoredAxes, all_axes};
use crate::tree::fit::Moments;
use crate::tree::frame::{DEVIATION_ERROR, MOST_DEVIATION, deviation};
use crate::tree::node::{Below, OrientedBox, WIDTH, WideNode};
use crate::tree::wide_boxes::{HALF, outward};
use d2m_lanes::{Doubles, F64x4, InstructionSet, Lanes, Quad, Task, run_on};
use d2m_testing::{Draw, KnuthRandom};
use glam::DVec3;

#[test]
fn numbers_are_rounded_outward() {
    let mut random = KnuthRandom(3);
    for power in -300..4 {
        let scale = f64::from(power).exp2();
        let numbers: [f64; HALF] = [(); HALF].map(|()| (1.0 + random.unit()) * scale);
        for (x, up) in numbers.into_iter().zip(Doubles::narrow(outward(F64x4::load(&Quad(numbers))))) {
            assert!(f64::from(up) >= x && f64::from(up) <= x * (1.0 + 5e-7) + 4e-45, "{x:e} {up:e}");
        }
    }
    assert_eq!(Doubles::narrow(outward(F64x4::load(&Quad([0.0; HALF])))), [1e-45; HALF]);
}

#[test]
fn every_instruction_set_fits_the_same_boxes() {
    let mut random = KnuthRandom(5);
    let points: Vec<[f64; 3]> = (0..400).map(|k| (random.vector() * [1.0, 1e-3][k % 2]).to_array()).collect();
    for used in 1..=WIDTH {
        // Parts of three to many points, some of them triangles.
        let counts: Vec<u32> = (0..used as u32).map(|lane| 3 + lane * (lane % 3) * 5).collect();
        let lists: Vec<Vec<u32>> =
            counts.iter().map(|&count| (0..count).map(|k| (k * 37 + count) % 400).collect()).collect();
        let parts: Vec<&[u32]> = lists.iter().map(Vec::as_slice).collect();
        let below: Vec<Below> = (0..)
            .zip(&counts)
            .map(|(lane, &count)| if count == 3 { Below::Triangle(lane) } else { Below::Node(lane) })
            .collect();
        let fitted = |set: InstructionSet| {
            let mut node = WideNode::empty([0.0; 3], 0);
            let mut moments = vec![Moments([1.0; Moments::LENGTH]); used];
            let (parts, below, rows) = (&parts[..], &below[..], &mut Rows::default());
            let siblings = Siblings {
                points: &points,
                parts,
                below,
                moments: &mut moments,
                origin: None,
                parent: 0,
                rows,
                node: &mut node,
            };
            let all = run_on(set, siblings);
            format!("{node:?} {all:?}")
        };
        let portable = fitted(InstructionSet::Portable);
        for set in InstructionSet::available() {
            assert!(fitted(set) == portable, "{used} {set:?}");
        }
    }
}

/// What the axes of eight boxes are taken for where they are fitted, and where a node is read.
struct AllAxes<'a>(&'a StoredAxes, &'a WideNode);

impl Task for AllAxes<'_> {
    type Output = [[[[f32; WIDTH]; 3]; 3]; 2];

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let Self(stored, node) = self;
        let stored = stored.map(|axis| axis.map(|lanes| L::load(&lanes)));
        [all_axes(&stored), node.wide_axes::<L>()].map(|axes| axes.map(|axis| axis.map(L::store)))
    }
}

#[test]
fn third_axes_are_the_same_for_all_and_frames_that_they_spoil_are_replaced() {
    // A frame whose cross product in f32 is 5.5u off, and one that is fine.
    let spoiled = [
        [0.568_193_356_296_273_3, 0.640_194_028_992_374_7, -0.517_018_292_813_017_3],
        [0.818_192_814_597_06, -0.506_587_058_634_243_8, 0.271_900_846_217_806_25],
    ];
    let fine = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]];
    let mut stored: StoredAxes = [[[0.0; WIDTH]; 3]; 2];
    for lane in 0..WIDTH {
        let frame: &[[f64; 3]; 2] = if lane == 5 { &spoiled } else { &fine };
        for (row, axis) in stored.iter_mut().zip(frame) {
            for k in 0..3 {
                row[k][lane] = axis[k] as f32;
            }
        }
    }
    let off = |axes: &[[f32; 3]; 3]| -> f64 {
        deviation(&axes.map(|axis| axis.map(|x| F64x4::splat(f64::from(x))))).store().0[0]
    };
    let mut node = WideNode::empty([0.0; 3], 0);
    node.axes = stored;
    assert!(off(&node.axes_of(5)) > MOST_DEVIATION, "{:e}", off(&node.axes_of(5)));
    for set in InstructionSet::available() {
        let [fitted, read] = run_on(set, AllAxes(&stored, &node));
        for lane in 0..WIDTH {
            let of = |axes: &[[[f32; WIDTH]; 3]; 3]| axes.map(|axis| axis.map(|lanes| lanes[lane]));
            assert_eq!(of(&read), node.axes_of(lane), "{set:?}");
            assert!(off(&of(&fitted)) <= MOST_DEVIATION - DEVIATION_ERROR, "{set:?}");
            assert_eq!(of(&fitted) == of(&read), lane != 5, "{set:?}");
        }
    }
}

/// The sizes of a node's lanes, and which of them are larger than one and expanded.
struct Sizes<'a>(&'a WideNode, f32);

impl Task for Sizes<'_> {
    type Output = ([f32; WIDTH], [u32; WIDTH]);

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let sizes = self.0.wide_sizes::<L>();
        let wide = d2m_lanes::WideSide { children: &self.0.child, flag: 1 << 30 };
        (sizes.store(), sizes.larger(wide, d2m_lanes::SingleSide { size: self.1, tag: 77 }))
    }
}

#[test]
fn the_larger_box_is_expanded_and_never_a_triangle() {
    let mut random = KnuthRandom(6);
    for round in 0..200 {
        let mut node = WideNode::empty([0.0; 3], 0);
        let used = 1 + round % WIDTH;
        for lane in 0..used {
            let half = (random.vector().abs() * 0.1).as_vec3().to_array();
            let boxed = node.oriented_box(lane);
            node.set_box(lane, &OrientedBox { half_extent: half, radius: 0.2, ..boxed });
            let number = 3 + lane as u32;
            let is_leaf = random.signed() < 0.0;
            node.set_below(lane, if is_leaf { Below::Triangle(number) } else { Below::Node(number) });
        }
        let single = if round % 3 == 0 { 0.0 } else { node.oriented_box(0).half_extent.iter().product() };
        for set in InstructionSet::available() {
            let (sizes, expanded) = run_on(set, Sizes(&node, single));
            for lane in 0..WIDTH {
                let is_node = lane < used && matches!(node.below(lane), Below::Node(_));
                assert!(!is_node || sizes[lane] == node.size(lane) && sizes[lane] > 0.0, "{set:?}");
                assert!(is_node || node.size(lane) == 0.0, "{set:?}");
                let is_larger = is_node && sizes[lane] > single;
                let tag = if is_larger { node.child[lane] | 1 << 30 } else { 77 };
                assert_eq!(expanded[lane], tag, "{set:?} {round} {lane}");
            }
        }
    }
}

/// The topmost box has its points in all lanes: the same box as with all of them in one, and points in each lane count.
#[test]
fn one_box_around_many_points_is_fitted_in_all_lanes_alike() {
    let mut random = KnuthRandom(7);
    for count in [4, 9, 33, 400, 3000] {
        let points: Vec<[f64; 3]> =
            (0..count).map(|_| (random.vector() * DVec3::new(1.0, 0.3, 0.2)).to_array()).collect();
        let part: Vec<u32> = (0..count).collect();
        let moments = points.iter().fold(Moments::default(), |mut sum, &[x, y, z]| {
            sum.add(&Moments([1.0, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z]));
            sum
        });
        let fitted = |set: InstructionSet, lanes: usize| {
            let mut node = WideNode::empty([0.0; 3], 0);
            let siblings = Siblings {
                points: &points,
                parts: &vec![&part[..]; lanes],
                below: &vec![Below::Node(1); lanes],
                moments: &mut vec![moments; lanes],
                origin: Some([0.1, 0.0, 0.0]),
                parent: 0,
                rows: &mut Rows::default(),
                node: &mut node,
            };
            run_on(set, siblings);
            node.oriented_box(0)
        };
        for set in InstructionSet::available() {
            assert_eq!(fitted(set, 1), fitted(InstructionSet::Portable, 2), "{count} {set:?}");
        }
    }
}
