//! Sine and cosine in double-double arithmetic, for poses at an epoch and for far reference points.

use d2m_lanes::DoubleDouble;

/// π/2 to 2⁻¹⁰⁷.
const HALF_PI: DoubleDouble = DoubleDouble::new(core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);
/// What [`HALF_PI`] leaves out.
const HALF_PI_TAIL: f64 = -1.497_384_904_859_17e-33;

/// Terms of a series that double-double arithmetic adds up. The rest is less than 2⁻⁵⁸ for |r| ≤ π/4 and is added up in doubles, which errs
/// by less than 2⁻¹⁰⁸.
const ACCURATE_TERMS: usize = 9;

/// 1/(2j)!, to 2⁻¹⁰⁶ of each.
const EVEN: [DoubleDouble; 15] = [
    DoubleDouble::new(1.0, 0.0),
    DoubleDouble::new(0.5, 0.0),
    DoubleDouble::new(0.041_666_666_666_666_664, 2.312_964_634_635_742_7e-18),
    DoubleDouble::new(0.001_388_888_888_888_889, -5.300_543_954_373_577e-20),
    DoubleDouble::new(2.480_158_730_158_73e-05, 2.151_194_786_677_588_2e-23),
    DoubleDouble::new(2.755_731_922_398_589e-07, 2.376_771_462_225_029_7e-23),
    DoubleDouble::new(2.087_675_698_786_81e-09, -1.207_345_059_113_26e-25),
    DoubleDouble::new(1.147_074_559_772_972_5e-11, 2.065_551_275_283_074_5e-28),
    DoubleDouble::new(4.779_477_332_387_385e-14, 4.399_205_485_834_081e-31),
    DoubleDouble::new(1.561_920_696_858_622_5e-16, 1.191_067_966_027_375_4e-32),
    DoubleDouble::new(4.110_317_623_312_165e-19, 1.441_297_337_865_952_7e-36),
    DoubleDouble::new(8.896_791_392_450_574e-22, -7.911_402_614_872_376e-38),
    DoubleDouble::new(1.611_737_571_096_118_4e-24, -3.684_657_356_450_976_6e-41),
    DoubleDouble::new(2.479_596_263_224_797_6e-27, -1.295_373_096_476_522_9e-43),
    DoubleDouble::new(3.279_889_237_069_838e-30, 1.511_754_274_402_987_9e-46),
];

/// 1/(2j + 1)!, to 2⁻¹⁰⁶ of each.
const ODD: [DoubleDouble; 15] = [
    DoubleDouble::new(1.0, 0.0),
    DoubleDouble::new(0.166_666_666_666_666_66, 9.251_858_538_542_97e-18),
    DoubleDouble::new(0.008_333_333_333_333_333, 1.156_482_317_317_871_4e-19),
    DoubleDouble::new(0.000_198_412_698_412_698_4, 1.720_955_829_342_070_5e-22),
    DoubleDouble::new(2.755_731_922_398_589_3e-06, -1.858_393_274_046_472e-22),
    DoubleDouble::new(2.505_210_838_544_172e-08, -1.448_814_070_935_912e-24),
    DoubleDouble::new(1.605_904_383_682_161_3e-10, 1.258_529_458_875_209_8e-26),
    DoubleDouble::new(7.647_163_731_819_816e-13, 7.038_728_777_334_53e-30),
    DoubleDouble::new(2.811_457_254_345_520_6e-15, 1.650_884_273_086_143_3e-31),
    DoubleDouble::new(8.220_635_246_624_33e-18, 2.214_189_411_960_426_5e-34),
    DoubleDouble::new(1.957_294_106_339_126_3e-20, -1.364_350_383_008_790_8e-36),
    DoubleDouble::new(3.868_170_170_630_684e-23, -8.843_177_655_482_344e-40),
    DoubleDouble::new(6.446_950_284_384_474e-26, -1.933_040_423_370_346_5e-42),
    DoubleDouble::new(9.183_689_863_795_546e-29, 1.430_315_039_678_732_2e-45),
    DoubleDouble::new(1.130_996_288_644_771_6e-31, 1.049_801_541_295_950_6e-47),
];

/// Reduction by multiples of π/2 (2⁻¹⁶⁰ left out), then the Taylor polynomials to r²⁸ and r²⁹, of which 2⁻¹¹⁸ is left out.
/// Absolute error below 2⁻⁹⁸ + |x|·2⁻¹⁰⁵ for |x| < 2³⁰.
pub(crate) fn sin_cos_double(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let turns = (x.hi / HALF_PI.hi).round();
    let r = (x - HALF_PI * turns).add_f64(-turns * HALF_PI_TAIL);
    let square = -(r * r);
    let sin = r * DoubleDouble::polynomial(square, &ODD, ACCURATE_TERMS);
    let cos = DoubleDouble::polynomial(square, &EVEN, ACCURATE_TERMS);
    match turns.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}
