//! Text forms: the interval that is read holds what is written, the text that is printed holds the interval.
use d2m_interval::{Interval, ParseIntervalError, interval};

fn read(text: &str) -> Interval {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn literals_are_enclosed_by_neighbours() {
    let tenth = interval!("0.1");
    // 0.1 as a double is a little more than a tenth.
    assert_eq!((tenth.lo(), tenth.hi()), (0.1_f64.next_down(), 0.1));
    assert_eq!(read("0.5"), Interval::point(0.5));
    assert_eq!(read("[1/3]"), Interval::new(1.0 / 3.0, (1.0_f64 / 3.0).next_up()));
    assert_eq!(read("[-1/3]"), -read("[1/3]"));
    assert_eq!(read("[0x1.8p-1, 0xAp0]"), Interval::new(0.75, 10.0));
    assert_eq!(read("1e400"), Interval::new(f64::MAX, f64::INFINITY));
    assert_eq!(read("-1e-400"), Interval::new(-5e-324, 0.0));
    assert_eq!(read("1e999999999999"), Interval::new(f64::MAX, f64::INFINITY));
    assert_eq!(read("[ -INF , 3 ]"), Interval::new(f64::NEG_INFINITY, 3.0));
    assert_eq!(read("[,]"), Interval::ENTIRE);
    assert_eq!(read("[]"), Interval::EMPTY);
    assert_eq!(read("2.50?"), Interval::new(2.495_f64.next_down(), 2.505).hull(read("[2.495, 2.505]")));
    assert_eq!(read("-10?12"), Interval::new(-22.0, 2.0));
    assert_eq!(read("10??u"), Interval::new(10.0, f64::INFINITY));
    // A half-way case with a digit far behind.
    let almost = format!("9007199254740993.{}1", "0".repeat(800));
    assert_eq!(read(&almost), Interval::new(9007199254740992.0, 9007199254740994.0));
    assert_eq!(read("9007199254740993"), Interval::new(9007199254740992.0, 9007199254740994.0));
    assert_eq!(read("2.2250738585072011e-308").width(), 5e-324);
}

#[test]
fn what_is_no_interval_is_refused() {
    for text in [
        "", "[", "]", "[1", "1]", "[1,2,3]", "[a]", "1e", "0x", "1.2.3", "[1;2]", "1/0", "--1", "[1 2]", "?",
        "1?x",
    ] {
        assert_eq!(text.parse::<Interval>(), Err(ParseIntervalError::Syntax), "{text}");
    }
    let nearly = "[1.00000000000000000002, 1.00000000000000000001]";
    for text in ["[2,1]", "[inf]", "[inf, 1]", "[1, -inf]", nearly] {
        assert_eq!(text.parse::<Interval>(), Err(ParseIntervalError::Order), "{text}");
    }
}

#[test]
fn printed_text_holds_the_interval() {
    let mut state = 1u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        f64::from_bits(state)
    };
    for round in 0..4000 {
        let (a, b) = (next(), next());
        if !a.is_finite() || !b.is_finite() {
            continue;
        }
        let scale = if round % 2 == 0 { 1.0 } else { 0.0 };
        let (a, b) = if scale == 0.0 { (a % 100.0, b % 100.0) } else { (a, b) };
        let x = Interval::new(a.min(b), a.max(b));
        let text = x.to_string();
        let back = read(&text);
        assert!(x.is_subset(back), "{x:?} {text}");
        assert!(
            back.lo() >= x.lo().next_down().next_down() && back.hi() <= x.hi().next_up().next_up(),
            "{x:?} {text}"
        );
        assert_eq!(read(&format!("{x:x}")), x);
        for places in [0, 1, 3, 20] {
            let text = format!("{x:.places$}");
            assert!(x.is_subset(read(&text)), "{x:?} {text}");
        }
    }
}

#[test]
fn printed_forms() {
    let x = Interval::new;
    assert_eq!(x(1.0, 2.0).to_string(), "[1, 2]");
    assert_eq!(x(-0.0, 1e300).to_string(), "[0, 1.0000000000000001e300]");
    assert_eq!(x(5e-324, 1e-7).to_string(), "[4.9406564584124654e-324, 9.9999999999999996e-8]");
    assert_eq!(format!("{:.1}", x(-0.01, 9.99)), "[-0.1, 10.0]");
    assert_eq!(format!("{:.0}", x(0.2, 99.5)), "[0, 100]");
    assert_eq!(format!("{:.2}", x(-99.999, 1e-9)), "[-100.00, 0.01]");
    assert_eq!(Interval::ENTIRE.to_string(), "[-inf, inf]");
    assert_eq!(format!("{:?}", x(0.1, 0.2)), "[0.1, 0.2]");
    assert_eq!(format!("{:x}", x(5e-324, 1.0)), "[0x0.0000000000001p-1022, 0x1p+0]");
}

#[cfg(feature = "serde")]
#[test]
fn serde_round_trip_is_exact_and_checked() {
    for x in [Interval::new(0.1, 0.3), Interval::EMPTY, Interval::ENTIRE, Interval::new(1.0, f64::INFINITY)] {
        let text = serde_json::to_string(&x).expect("serialises");
        assert_eq!(serde_json::from_str::<Interval>(&text).expect(&text), x);
    }
    assert_eq!(serde_json::to_string(&Interval::new(0.1, 0.5)).expect("serialises"), "[0.1,0.5]");
    for text in ["[2.0, 1.0]", "[1.0]", "\"[2,1]\"", "[null, 1.0]", "{}"] {
        assert!(serde_json::from_str::<Interval>(text).is_err(), "{text}");
    }
}
