//! Tests of the contents of plots.

use super::*;
use crate::STYLES;

fn plot(series: Vec<Series>) -> Plot {
    Plot {
        title: "Error & <price>".to_owned(),
        x: PlotAxis::log("queries"),
        y: PlotAxis::log("error"),
        series,
    }
}

#[test]
fn a_slope_is_that_of_its_power_law() {
    let points =
        |slope: f64| (1..=4).map(move |k| (10f64.powi(k), 10f64.powf(slope * f64::from(k))));
    let svg = plot(vec![
        Series::new("quantum", points(-1.0), Drawn::Fit),
        Series::new("classical", points(-0.5), Drawn::Fit),
    ])
    .draw()
    .svg();
    assert!(svg.contains("slope \u{2212}1.00 \u{b1} 0.00"), "{svg}");
    assert!(svg.contains("slope \u{2212}0.50 \u{b1} 0.00"), "{svg}");
    assert!(svg.contains("Error &amp; &lt;price&gt;"));
}

/// Over bits b, the slope is taken over 2^b.
#[test]
fn a_slope_over_bits_is_over_their_power_of_two() {
    let mut plot = plot(vec![Series::new(
        "steps",
        (2..9).map(|b| (f64::from(b), 0.5f64.powi(b))),
        Drawn::Fit,
    )]);
    plot.x = PlotAxis::bits("comparator bits");
    let svg = plot.draw().svg();
    assert!(svg.contains("slope \u{2212}1.00"), "{svg}");
    for bits in 2..9 {
        assert!(svg.contains(&format!(">{bits}</text>")), "{bits}");
    }
}

#[test]
fn what_has_no_logarithm_is_left_out() {
    let points = [
        (1.0, 0.0),
        (0.0, 1.0),
        (f64::NAN, 1.0),
        (10.0, f64::INFINITY),
        (-1.0, 2.0),
    ];
    let svg = plot(vec![Series::new("odd", points, Drawn::Joined)])
        .draw()
        .svg();
    assert!(svg.contains("nothing to show"));
    for word in ["NaN", "inf"] {
        assert!(!svg.contains(word), "{svg}");
    }
    // One point has a place, even if its error bar reaches down to zero.
    let mut series = Series::new("one", [(3.0, 0.1)], Drawn::Fit);
    series.points[0].low = 0.0;
    let svg = plot(vec![series]).draw().svg();
    assert!(!svg.contains("nothing to show") && !svg.contains("NaN") && !svg.contains("slope"));
}

#[test]
fn every_number_lies_on_the_drawing() {
    let points = (0..12).map(|k| {
        (
            1e3 * 1.7f64.powi(k),
            1e-7 * 1e4f64.powf((f64::from(k)).sin()),
        )
    });
    let series: Vec<Series> = (0..STYLES)
        .map(|n| {
            let shifted = points
                .clone()
                .map(move |(x, y)| (x, y * 1.3f64.powi(n as i32)));
            Series::new(&format!("series {n}"), shifted, Drawn::Fit)
        })
        .collect();
    let svg = plot(series).draw().svg();
    for part in svg.split(['"', ' ', 'M', 'L', 'H', 'V', 'z', '(', ')', '\n']) {
        if let Ok(number) = part.parse::<f64>() {
            assert!((-100.0..800.0).contains(&number), "{number}");
        }
    }
}

#[test]
fn ticks_are_numbers_that_people_write() {
    let axis = PlotAxis::log("x");
    let labels = |low, high| -> Vec<String> {
        let ticks = axis.ticks([low, high], 9).into_iter();
        ticks.map(|(_, label)| label).collect()
    };
    assert_eq!(labels(-2.1, 1.2), ["0.01", "0.1", "1", "10"]);
    assert_eq!(labels(-0.1, 1.1), ["1", "2", "5", "10"]);
    assert_eq!(
        labels(4.9, 8.1),
        ["10\u{2075}", "10\u{2076}", "10\u{2077}", "10\u{2078}"]
    );
    assert_eq!(labels(5.1, 5.8), ["2\u{b7}10\u{2075}", "5\u{b7}10\u{2075}"]);
    assert_eq!(labels(-20.0, 20.0).len(), 7);
}

/// A series that several plots draw has one colour in all of them.
#[test]
fn a_series_keeps_its_style_wherever_it_stands() {
    let points = [(1.0, 1.0), (10.0, 0.1)];
    let series = Series::new("digital net", points, Drawn::Joined).styled(2);
    let [alone, second] = [
        plot(vec![series.clone()]),
        plot(vec![
            Series::new("random paths", points, Drawn::Joined).styled(5),
            series,
        ]),
    ]
    .map(|plot| plot.draw().svg());
    for svg in [alone, second] {
        assert!(svg.contains("class=\"line s2\"") && svg.contains("class=\"mark s2\""));
        assert!(!svg.contains("class=\"line s0\"") && !svg.contains("class=\"line s1\""));
    }
}

/// Some letters of 14 pixels are wider and some narrower than 7 pixels; the average in DejaVu Sans
/// is 8.4.
#[test]
fn long_names_and_titles_are_whole() {
    for (title, name, width) in [
        ("errors", "abrams-williams", 580.0),
        (
            "errors",
            "AND, undone by measurement",
            436.0 + 16.0 + 26.0 * 8.4,
        ),
        (
            &*"a scene of a very long name ".repeat(4),
            "one",
            14.0 + 112.0 * 8.6,
        ),
    ] {
        let mut plot = plot(vec![Series::new(
            name,
            [(1.0, 1.0), (9.0, 2.0)],
            Drawn::Steps,
        )]);
        plot.title = title.to_owned();
        let svg = plot.draw().svg();
        let view = svg.split("viewBox=\"0 0 ").nth(1).unwrap();
        let found: f64 = view.split(' ').next().unwrap().parse().unwrap();
        assert!(
            found >= width && found <= width + 3.0,
            "{title}, {name}: {found}"
        );
    }
}
