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

/// Every digit counts, and only as much as it must: the reading of numbers beside doubles with up to 767 digits, of
/// which the sign of the difference is behind any number of zeros or nines.
#[test]
fn any_number_of_digits_is_read_exactly() {
    let exact = |x: f64| {
        let text = format!("{x:.1100}");
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    };
    let mut state = 7u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let mut doubles = vec![f64::MIN_POSITIVE, f64::MIN_POSITIVE.next_down(), 5e-324, f64::MAX, 1.0, 0.1];
    doubles.extend((0..40).map(|_| f64::from_bits(next() >> 1)).filter(|x| x.is_finite()));
    for x in doubles {
        let digits = exact(x);
        assert_eq!(read(&digits), Interval::point(x), "{x:e}");
        for zeros in [25, 700, 5000] {
            let point = if digits.contains('.') { "" } else { "." };
            let above = format!("{digits}{point}{}1", "0".repeat(zeros));
            assert_eq!(read(&above), Interval::new(x, x.next_up()), "{x:e} and {zeros} zeros");
            assert_eq!(read(&format!("-{above}")), Interval::new(-x.next_up(), -x));
            // The last digit, which is not 0, one less, and nines behind it.
            let (head, last) = digits.split_at(digits.len() - 1);
            if let Some(last) = last.parse::<u32>().ok().filter(|d| *d > 0) {
                let below = format!("{head}{}{point}{}", last - 1, "9".repeat(zeros));
                assert_eq!(read(&below), Interval::new(x.next_down(), x), "{x:e} and {zeros} nines");
            }
        }
        // The same in hexadecimal, which keeps 200 digits.
        let hexadecimal = format!("{:x}", Interval::point(x));
        let (_, upper) = hexadecimal.trim_matches(['[', ']']).split_once(", ").expect("two ends");
        let (mantissa, power) = upper.split_once('p').expect("a power");
        let point = if mantissa.contains('.') { "" } else { "." };
        for zeros in [25, 300, 5000] {
            let above = format!("{mantissa}{point}{}1p{power}", "0".repeat(zeros));
            assert_eq!(read(&above), Interval::new(x, x.next_up()), "{above}");
            let shifted = format!("0x0.{}1p{}", "0".repeat(zeros), 4 * (zeros + 1));
            assert_eq!(read(&shifted), Interval::ONE);
        }
    }
    // Exponents that make up for more digits than any limit.
    assert_eq!(read(&format!("0.{}1e1100001", "0".repeat(1_100_000))), Interval::ONE);
    assert_eq!(read(&format!("1{}e-1100000", "0".repeat(1_100_000))), Interval::ONE);
    assert_eq!(read(&format!("1{}/1{}", "0".repeat(5000), "0".repeat(5000))), Interval::ONE);
    assert_eq!(read(&format!("{}/{}", "7".repeat(5000), "7".repeat(5000))), Interval::ONE);
    assert_eq!(read(&format!("{}/{}", "3".repeat(5000), "9".repeat(5000))), read("1/3"));
    assert_eq!(read(&format!("{}?", "1".repeat(400))), Interval::new(f64::MAX, f64::INFINITY));
}

/// The order of numbers that round to the same double, in every pair of forms; nothing takes memory for its exponent.
#[test]
fn ends_in_the_wrong_order_are_refused_however_close() {
    let zeros = "0".repeat(3000);
    let (less, more) = (format!("1.{zeros}1"), format!("1.{zeros}2"));
    let third = "3".repeat(3000);
    for (lower, upper) in [
        (less.as_str(), more.as_str()),
        (&format!("0.{third}"), "1/3"),
        ("1e-400", "1e-399"),
        ("1e-999999999999", "0x1p-2000"),
        ("1e400", "1e999999999999"),
        ("0x1.00000000000000000001p0", "1.0000000000000001"),
        ("1/3", &format!("0.{third}4")),
        ("100000000000000000000000/300000000000000000000001", "1/3"),
    ] {
        let text = format!("[{lower}, {upper}]");
        assert!(text.parse::<Interval>().is_ok(), "{}", &text[..60.min(text.len())]);
        assert!(format!("[{lower}, {lower}]").parse::<Interval>().is_ok());
        for wrong in [format!("[{upper}, {lower}]"), format!("[-{lower}, -{upper}]")] {
            assert_eq!(
                wrong.parse::<Interval>(),
                Err(ParseIntervalError::Order),
                "{}",
                &wrong[..60.min(wrong.len())]
            );
        }
    }
    // What is cut off of hexadecimal digits refuses nothing.
    let long = format!("0x1.{zeros}1");
    assert_eq!(read(&format!("[{long}, {long}]")), Interval::new(1.0, 1.0_f64.next_up()));
}

/// Forty times the digits take less than 400 times the time (quadratic work would take 1600 times as long), and half a second for
/// what else the machine does.
#[test]
fn reading_is_linear_in_the_digits() {
    let time = |text: &str| {
        let start = std::time::Instant::now();
        assert!(text.parse::<Interval>().is_ok());
        start.elapsed().as_secs_f64()
    };
    let texts = |count: usize| {
        let digits = "123456789".repeat(count / 9);
        [
            format!("0.{digits}"),
            digits.clone(),
            format!("{digits}/{}", "7".repeat(count)),
            format!("0x{digits}"),
            format!("0.{digits}?5"),
            format!("[0.{digits}, 0.{digits}]"),
        ]
    };
    for (short, long) in texts(9_000).iter().zip(&texts(360_000)) {
        let (short, long) = (time(short), time(long));
        assert!(long < 400.0 * short + 0.5, "{short} s and {long} s");
    }
}

#[cfg(feature = "serde")]
#[test]
fn serde_round_trip_is_exact_and_checked() {
    for x in [Interval::new(0.1, 0.3), Interval::EMPTY, Interval::ENTIRE, Interval::new(1.0, f64::INFINITY)] {
        let text = serde_json::to_string(&x).expect("serialises");
        assert!(text.starts_with('"') && text.ends_with('"'), "no library rounds a string: {text}");
        assert_eq!(serde_json::from_str::<Interval>(&text).expect(&text), x);
    }
    let text = serde_json::to_string(&Interval::new(0.1, 0.5)).expect("serialises");
    assert_eq!(text, "\"[0x1.999999999999ap-4, 0x1p-1]\"");
    for text in ["[2.0, 1.0]", "[1.0]", "\"[2,1]\"", "[null, 1.0]", "{}", "[\"2\", \"1\"]", "[\"x\", 1]"] {
        assert!(serde_json::from_str::<Interval>(text).is_err(), "{text}");
    }
}

/// The pair of numbers of 0.1.0: read outward, as far as a library may have rounded it.
#[cfg(feature = "serde")]
#[test]
fn pairs_of_numbers_are_read_outward() {
    let read = |text: &str| serde_json::from_str::<Interval>(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    let mut state = 3u64;
    for _ in 0..2000 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let x = f64::from_bits(state);
        if !x.is_finite() {
            continue;
        }
        // The neighbours that a reader may hand over instead.
        for given in [x.next_down().next_down(), x, x.next_up().next_up()] {
            let back = read(&format!("[{given:?}, {given:?}]"));
            assert!(
                back.contains(x) && back.width() <= 9.0 * (x.next_up() - x).abs().max(5e-324),
                "{x:e} {back:?}"
            );
        }
    }
    assert_eq!(read("[0, 3]"), Interval::new(0.0, 3.0));
    assert_eq!(read("[-9007199254740993, 9007199254740993]").hi(), 9007199254740994.0);
    assert_eq!(read("[\"0x1p-1\", \"inf\"]").lo(), 0.5);
    assert!(Interval::new(0.1, 0.5).is_subset(read("[0.1, 0.5]")));
}
