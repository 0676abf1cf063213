use super::*;
use crate::statistics::Summary;

#[test]
fn decades_hold_all_values_and_are_labelled() {
    let axis = Axis::decades("x", [3.3e-10, 1e-10, 0.0, f64::INFINITY]);
    assert_eq!((axis.lo, axis.hi), (1e-10, 1e-9));
    assert_eq!(axis.place(1e-10), 0.0);
    assert!((axis.place(1e-9) - 1.0).abs() < 1e-12);
    let labels: Vec<String> = axis.ticks().into_iter().map(|t| t.1).collect();
    assert_eq!(labels, ["10⁻¹⁰", "2·10⁻¹⁰", "5·10⁻¹⁰", "10⁻⁹"]);
    let wide: Vec<String> = Axis::decades("x", [0.01, 1e5]).ticks().into_iter().map(|t| t.1).collect();
    assert_eq!(wide, ["0.01", "0.1", "1", "10", "100", "1000", "10000", "10⁵"]);
    assert!(Axis::decades("x", [1e-12, 1e12]).ticks().len() <= 10);
}

#[test]
fn zero_has_a_place_on_a_logarithmic_axis() {
    let axis = Axis::decades_and_zero("x", [0.0, 0.1, 300.0]);
    assert_eq!((axis.place(0.0), axis.place(1000.0)), (0.0, 1.0));
    assert!((axis.place(0.1) - 0.2).abs() < 1e-12);
    let labels: Vec<String> = axis.ticks().into_iter().map(|t| t.1).collect();
    assert_eq!(labels, ["0", "0.1", "1", "10", "100", "1000"]);
    assert_eq!(Axis::decades_and_zero("x", [0.1, 300.0]).ticks().len(), 5);
}

#[test]
fn linear_axes_end_on_round_numbers() {
    let axis = Axis::linear("x", [0.3, 1.97]);
    assert_eq!((axis.lo, axis.hi), (0.0, 2.0));
    assert_eq!(axis.ticks().len(), 5);
    let labels: Vec<String> = Axis::counts("x", [1.0, 2.0]).ticks().into_iter().map(|t| t.1).collect();
    assert_eq!(labels, ["0", "1", "2", "3"]);
}

#[test]
fn figures_hold_their_words() {
    let path = std::env::temp_dir().join(format!("d2m-figure-{}.svg", std::process::id()));
    let summary = Summary::of([1e-10, 2e-10, 3.3e-10]).unwrap();
    let rows = vec![BoxRow { kind: 0, summary }];
    let group = Group { name: "gear/gear".into(), note: "476 triangles".into(), rows };
    let plot = BoxPlot {
        title: "Title".into(),
        axis: "separation".into(),
        legend: vec!["a".into()],
        groups: vec![group],
    };
    plot.draw(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(["gear/gear", "476 triangles", "10⁻¹⁰", "separation"].iter().all(|w| text.contains(w)));
    let series = Series { name: "s".into(), points: vec![(1.0, 2.0), (10.0, 3.0)], spread: vec![] };
    let (x, y) = (Axis::decades("x", [1.0, 10.0]), Axis::linear("µs", [3.0]));
    LinePlot { title: "L".into(), x, y, series: vec![series] }.draw(&path).unwrap();
    assert!(std::fs::read_to_string(&path).unwrap().contains("µs"));
    std::fs::remove_file(&path).unwrap();
}
