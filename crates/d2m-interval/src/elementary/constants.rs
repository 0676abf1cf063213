//! Constants as unevaluated sums of two doubles: nearest double, then nearest double of the rest.
//! Each was computed with 1500-bit integers; a test recomputes them.
use d2m_lanes::DoubleDouble;

/// ln 2
pub(super) const LN_2: DoubleDouble =
    DoubleDouble::new(f64::from_bits(0x3FE6_2E42_FEFA_39EF), f64::from_bits(0x3C7A_BC9E_3B39_803F));
/// 1/ln 2
pub(super) const LOG2_E: DoubleDouble =
    DoubleDouble::new(f64::from_bits(0x3FF7_1547_652B_82FE), f64::from_bits(0x3C77_77D0_FFDA_0D24));
/// ln 10
pub(super) const LN_10: DoubleDouble =
    DoubleDouble::new(f64::from_bits(0x4002_6BB1_BBB5_5516), f64::from_bits(0xBCAF_48AD_494E_A3E9));
/// 1/ln 10
pub(super) const LOG10_E: DoubleDouble =
    DoubleDouble::new(f64::from_bits(0x3FDB_CB7B_1526_E50E), f64::from_bits(0x3C69_5355_BAAA_FAD3));
/// ln 10 / ln 2
pub(super) const LOG2_10: DoubleDouble =
    DoubleDouble::new(f64::from_bits(0x400A_934F_0979_A371), f64::from_bits(0x3CA7_F249_5FB7_FA6D));
/// π/2
pub(super) const FRAC_PI_2: DoubleDouble =
    DoubleDouble::new(f64::from_bits(0x3FF9_21FB_5444_2D18), f64::from_bits(0x3C91_A626_3314_5C07));
/// π
pub(super) const PI: DoubleDouble =
    DoubleDouble::new(f64::from_bits(0x4009_21FB_5444_2D18), f64::from_bits(0x3CA1_A626_3314_5C07));
/// ln 2 in three parts; the first two have 42 bits, so that their products with |k| < 2¹¹ are exact.
pub(super) const LN_2_PARTS: [f64; 3] = [
    f64::from_bits(0x3FE6_2E42_FEFA_3800),
    f64::from_bits(0x3D2E_F357_93C7_6000),
    f64::from_bits(0x3A8C_C01F_97B5_7A08),
];
/// 1/n!
pub(super) const INVERSE_FACTORIAL: [DoubleDouble; 24] = [
    DoubleDouble::new(f64::from_bits(0x3FF0_0000_0000_0000), f64::from_bits(0x0000_0000_0000_0000)),
    DoubleDouble::new(f64::from_bits(0x3FF0_0000_0000_0000), f64::from_bits(0x0000_0000_0000_0000)),
    DoubleDouble::new(f64::from_bits(0x3FE0_0000_0000_0000), f64::from_bits(0x0000_0000_0000_0000)),
    DoubleDouble::new(f64::from_bits(0x3FC5_5555_5555_5555), f64::from_bits(0x3C65_5555_5555_5555)),
    DoubleDouble::new(f64::from_bits(0x3FA5_5555_5555_5555), f64::from_bits(0x3C45_5555_5555_5555)),
    DoubleDouble::new(f64::from_bits(0x3F81_1111_1111_1111), f64::from_bits(0x3C01_1111_1111_1111)),
    DoubleDouble::new(f64::from_bits(0x3F56_C16C_16C1_6C17), f64::from_bits(0xBBEF_49F4_9F49_F49F)),
    DoubleDouble::new(f64::from_bits(0x3F2A_01A0_1A01_A01A), f64::from_bits(0x3B6A_01A0_1A01_A01A)),
    DoubleDouble::new(f64::from_bits(0x3EFA_01A0_1A01_A01A), f64::from_bits(0x3B3A_01A0_1A01_A01A)),
    DoubleDouble::new(f64::from_bits(0x3EC7_1DE3_A556_C734), f64::from_bits(0xBB6C_154F_8DDC_6C00)),
    DoubleDouble::new(f64::from_bits(0x3E92_7E4F_B778_9F5C), f64::from_bits(0x3B3C_BBC0_5B4F_A99A)),
    DoubleDouble::new(f64::from_bits(0x3E5A_E645_67F5_44E4), f64::from_bits(0xBAFC_062E_06D1_F209)),
    DoubleDouble::new(f64::from_bits(0x3E21_EED8_EFF8_D898), f64::from_bits(0xBAC2_AEC9_59E1_4C06)),
    DoubleDouble::new(f64::from_bits(0x3DE6_1246_13A8_6D09), f64::from_bits(0x3A8F_28E0_CC74_8EBE)),
    DoubleDouble::new(f64::from_bits(0x3DA9_3974_A8C0_7C9D), f64::from_bits(0x3A30_5D6F_8A2E_FD1F)),
    DoubleDouble::new(f64::from_bits(0x3D6A_E7F3_E733_B81F), f64::from_bits(0x39E1_D865_6B0E_E8CB)),
    DoubleDouble::new(f64::from_bits(0x3D2A_E7F3_E733_B81F), f64::from_bits(0x39A1_D865_6B0E_E8CB)),
    DoubleDouble::new(f64::from_bits(0x3CE9_52C7_7030_AD4A), f64::from_bits(0x398A_C981_465D_DC6C)),
    DoubleDouble::new(f64::from_bits(0x3CA6_8278_63B9_7D97), f64::from_bits(0x394E_EC01_221A_8B0B)),
    DoubleDouble::new(f64::from_bits(0x3C62_F49B_4681_4157), f64::from_bits(0x38F2_650F_61DB_DCB4)),
    DoubleDouble::new(f64::from_bits(0x3C1E_542B_A402_0225), f64::from_bits(0x387E_A72B_4AFE_3C2F)),
    DoubleDouble::new(f64::from_bits(0x3BD7_1B8E_F6DC_F572), f64::from_bits(0xB87D_043A_E40C_4647)),
    DoubleDouble::new(f64::from_bits(0x3B90_CE39_6DB7_F853), f64::from_bits(0xB83A_EBCD_BD20_331C)),
    DoubleDouble::new(f64::from_bits(0x3B47_61B4_1316_381A), f64::from_bits(0xB7D3_423C_7D91_404F)),
];
/// 1/(2n + 1)
pub(super) const INVERSE_ODD: [DoubleDouble; 16] = [
    DoubleDouble::new(f64::from_bits(0x3FF0_0000_0000_0000), f64::from_bits(0x0000_0000_0000_0000)),
    DoubleDouble::new(f64::from_bits(0x3FD5_5555_5555_5555), f64::from_bits(0x3C75_5555_5555_5555)),
    DoubleDouble::new(f64::from_bits(0x3FC9_9999_9999_999A), f64::from_bits(0xBC69_9999_9999_999A)),
    DoubleDouble::new(f64::from_bits(0x3FC2_4924_9249_2492), f64::from_bits(0x3C62_4924_9249_2492)),
    DoubleDouble::new(f64::from_bits(0x3FBC_71C7_1C71_C71C), f64::from_bits(0x3C5C_71C7_1C71_C71C)),
    DoubleDouble::new(f64::from_bits(0x3FB7_45D1_745D_1746), f64::from_bits(0xBC47_45D1_745D_1746)),
    DoubleDouble::new(f64::from_bits(0x3FB3_B13B_13B1_3B14), f64::from_bits(0xBC53_B13B_13B1_3B14)),
    DoubleDouble::new(f64::from_bits(0x3FB1_1111_1111_1111), f64::from_bits(0x3C31_1111_1111_1111)),
    DoubleDouble::new(f64::from_bits(0x3FAE_1E1E_1E1E_1E1E), f64::from_bits(0x3C2E_1E1E_1E1E_1E1E)),
    DoubleDouble::new(f64::from_bits(0x3FAA_F286_BCA1_AF28), f64::from_bits(0x3C4A_F286_BCA1_AF28)),
    DoubleDouble::new(f64::from_bits(0x3FA8_6186_1861_8618), f64::from_bits(0x3C48_6186_1861_8618)),
    DoubleDouble::new(f64::from_bits(0x3FA6_42C8_590B_2164), f64::from_bits(0x3C36_42C8_590B_2164)),
    DoubleDouble::new(f64::from_bits(0x3FA4_7AE1_47AE_147B), f64::from_bits(0xBC2E_B851_EB85_1EB8)),
    DoubleDouble::new(f64::from_bits(0x3FA2_F684_BDA1_2F68), f64::from_bits(0x3C42_F684_BDA1_2F68)),
    DoubleDouble::new(f64::from_bits(0x3FA1_A7B9_611A_7B96), f64::from_bits(0x3C21_A7B9_611A_7B96)),
    DoubleDouble::new(f64::from_bits(0x3FA0_8421_0842_1084), f64::from_bits(0x3C30_8421_0842_1084)),
];
/// atan(n/8)
pub(super) const ATAN_EIGHTHS: [DoubleDouble; 9] = [
    DoubleDouble::new(0.0, 0.0),
    DoubleDouble::new(f64::from_bits(0x3FBF_D5BA_9AAC_2F6E), f64::from_bits(0xBC4C_D376_8676_0C17)),
    DoubleDouble::new(f64::from_bits(0x3FCF_5B75_F92C_80DD), f64::from_bits(0x3C68_AB6E_3CF7_AFBD)),
    DoubleDouble::new(f64::from_bits(0x3FD6_F619_41E4_DEF1), f64::from_bits(0xBC7C_63AA_E6F6_E918)),
    DoubleDouble::new(f64::from_bits(0x3FDD_AC67_0561_BB4F), f64::from_bits(0x3C7A_2B7F_222F_65E2)),
    DoubleDouble::new(f64::from_bits(0x3FE1_E00B_ABDE_FEB4), f64::from_bits(0xBC59_28DF_287A_668F)),
    DoubleDouble::new(f64::from_bits(0x3FE4_978F_A326_9EE1), f64::from_bits(0x3C72_419A_87F2_A458)),
    DoubleDouble::new(f64::from_bits(0x3FE7_00A7_C578_4634), f64::from_bits(0xBC78_C34D_25AA_DEF6)),
    DoubleDouble::new(f64::from_bits(0x3FE9_21FB_5444_2D18), f64::from_bits(0x3C81_A626_3314_5C07)),
];
/// The first 1344 binary digits of 2/π.
pub(super) const TWO_OVER_PI: [u64; 21] = [
    0xA2F9_836E_4E44_1529,
    0xFC27_57D1_F534_DDC0,
    0xDB62_9599_3C43_9041,
    0xFE51_63AB_DEBB_C561,
    0xB724_6E3A_424D_D2E0,
    0x0649_2EEA_09D1_921C,
    0xFE1D_EB1C_B129_A73E,
    0xE882_35F5_2EBB_4484,
    0xE99C_7026_B45F_7E41,
    0x3991_D639_8353_39F4,
    0x9C84_5F8B_BDF9_283B,
    0x1FF8_97FF_DE05_980F,
    0xEF2F_118B_5A0A_6D1F,
    0x6D36_7ECF_27CB_09B7,
    0x4F46_3F66_9E5F_EA2D,
    0x7527_BAC7_EBE5_F17B,
    0x3D07_39F7_8A52_92EA,
    0x6BFB_5FB1_1F8D_5D08,
    0x5603_3046_FC7B_6BAB,
    0xF0CF_BC20_9AF4_361D,
    0xA9E3_9161_5EE6_1B08,
];
