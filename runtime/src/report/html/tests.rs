//! The page as a browser and as a person read it.

use super::html;
use crate::identify::tests::hand_written::scara;
use crate::identify::tests::synthetic;
use crate::identify::{Progress, identify, series};
use crate::log::Recording;
use crate::observe::ModelKind;
use crate::report::{Identification, Role, Truth};

/// An identification with everything a page can show: two logs, one of them held out.
fn drawn(held_out: bool) -> Identification {
    let model = scara();
    let train = noisy(synthetic::log("run.csv", 0.0, 3000));
    let valid = noisy(synthetic::log("other.csv", 1.0, 3000));
    let valid = if held_out { vec![valid] } else { vec![] };
    let (options, quiet): (_, &dyn Progress) = (synthetic::options(), &());
    let train = [train];
    let mut result = identify(&model, &train, &valid, &options, quiet).unwrap();
    for (logs, role) in [(&train[..], Role::Training), (&valid[..], Role::Validation)] {
        for log in logs {
            let drawn = series(&model, log, role, &result).unwrap();
            result.series.push(drawn);
        }
    }
    result.command = Some("idim identify scara run.csv --html page.html".to_owned());
    result
}

fn noisy(log: Recording) -> Recording {
    let tau = log.tau.as_deref().map(synthetic::disturbed);
    Recording { tau, ..log }
}

/// The page without its first line, which is no XML.
fn document(page: &str) -> roxmltree::Document<'_> {
    let (first, rest) = page.split_once('\n').unwrap();
    assert_eq!(first, "<!DOCTYPE html>");
    roxmltree::Document::parse(rest).unwrap()
}

fn classed<'a>(document: &'a roxmltree::Document<'_>, class: &str) -> Vec<roxmltree::Node<'a, 'a>> {
    let words = |node: &roxmltree::Node<'_, '_>| -> bool {
        let classes = node.attribute("class").unwrap_or("");
        class
            .split(' ')
            .all(|class| classes.split(' ').any(|word| word == class))
    };
    document.descendants().filter(|node| words(node)).collect()
}

#[test]
fn the_page_is_well_formed_and_every_joint_has_its_marks() {
    let result = drawn(true);
    let page = html(&result);
    let document = document(&page);
    let joints = 2;
    assert_eq!(classed(&document, "bar held").len(), joints + 1);
    assert_eq!(classed(&document, "bar training").len(), joints + 1);
    assert_eq!(
        classed(&document, "whisker").len(),
        result.models[0].parameters.len()
    );
    // Two logs; torque, residual, spectrum and autocorrelation of three models.
    assert_eq!(
        classed(&document, "curve explicit residual").len(),
        2 * joints
    );
    assert_eq!(classed(&document, "curve stems power").len(), 2 * joints);
    for curve in classed(&document, "area")
        .iter()
        .flat_map(|area| area.children())
    {
        let (Some(d), Some(class)) = (curve.attribute("d"), curve.attribute("class")) else {
            continue;
        };
        if class.starts_with("curve") {
            assert!(d.split(['M', 'L', 'V']).count() > 30, "{class}: {d}");
            assert!(!d.contains("NaN") && !d.contains("inf"), "{class}: {d}");
        }
    }
    assert!(page.contains("Held out: other.csv") && page.contains("Training: run.csv"));
    assert!(page.contains("idim identify scara run.csv --html page.html"));
}

#[test]
fn the_page_asks_nobody_for_anything() {
    let page = html(&drawn(true));
    for piece in [
        "http:", "https:", "src=", "url(", "@import", "<link", "fetch(", "//cdn",
    ] {
        assert!(!page.contains(piece), "{piece}");
    }
    assert!(page.contains("default-src &#39;none&#39;"));
    assert!(page.len() < 600_000, "{}", page.len());
}

#[test]
fn no_name_becomes_markup() {
    const EVIL: &str = "</title></script><script>alert('\"&\u{7}')</script><img onerror=x>";
    let mut result = drawn(true);
    result.robot = EVIL.into();
    result.logs = vec![EVIL.into()];
    result.warnings = vec![EVIL.into()];
    result.command = Some(EVIL.into());
    result.truth = Some(Truth {
        title: EVIL.into(),
        about: EVIL.into(),
        values: vec![1.0; 8],
    });
    for model in &mut result.models {
        model.validation[0].log = EVIL.into();
        let fits = [&mut model.fit, &mut model.validation[0].fit];
        fits.into_iter()
            .flat_map(|fit| &mut fit.joints)
            .for_each(|joint| joint.name = EVIL.into());
        for parameter in &mut model.parameters {
            parameter.name = EVIL.into();
            parameter.unit = EVIL.into();
            parameter.relation = EVIL.into();
        }
    }
    for log in &mut result.series {
        log.log = EVIL.into();
        log.joints
            .iter_mut()
            .for_each(|joint| joint.name = EVIL.into());
    }
    let page = html(&result);
    let document = document(&page);
    let count = |name| {
        document
            .descendants()
            .filter(|node| node.has_tag_name(name))
            .count()
    };
    assert_eq!((count("script"), count("img"), count("style")), (1, 0, 1));
    assert!(!page.contains("<img") && !page.contains('\u{7}'));
    let on = |a: &roxmltree::Attribute<'_, '_>| a.name().starts_with("on");
    assert!(
        document
            .descendants()
            .all(|node| !node.attributes().any(|a| on(&a)))
    );
}

#[test]
fn the_same_value_gives_the_same_page() {
    let result = drawn(true);
    assert_eq!(html(&result), html(&result.clone()));
    assert_eq!(html(&drawn(true)), html(&result));
}

#[test]
fn without_a_held_out_log_the_page_says_so() {
    let page = html(&drawn(false));
    let document = document(&page);
    assert!(page.contains("No log was held out"));
    assert!(classed(&document, "bar held").is_empty());
}

#[test]
fn known_truth_is_drawn_and_compared() {
    let mut result = drawn(false);
    result.truth = Some(Truth {
        title: "The paper".into(),
        about: "Known.".into(),
        values: synthetic::X.to_vec(),
    });
    let page = html(&result);
    let document = document(&page);
    assert_eq!(classed(&document, "truth").len(), 8);
    assert!(page.contains("Largest error against the true values: explicit "));
    assert!(page.contains("<title>The paper</title>"));
}

#[test]
fn what_is_drawn_is_what_was_scored() {
    let result = drawn(true);
    for log in &result.series {
        for (k, model) in result.models.iter().enumerate() {
            let fit = match log.role {
                Role::Training => &model.fit,
                Role::Validation => &model.validation[0].fit,
            };
            for (joint, scored) in log.joints.iter().zip(&fit.joints) {
                let drawn = &joint.models[k];
                assert!((drawn.rel_pct / scored.rel_pct - 1.0).abs() < 1e-9);
                assert!((drawn.rmse / scored.rmse - 1.0).abs() < 1e-9);
                // Nothing is thinned here, so the residual that is drawn has that size too.
                let residual = joint.residual(drawn);
                let square: f64 = residual.iter().map(|r| r * r).sum();
                let rms = (square / residual.len() as f64).sqrt();
                assert!(
                    (rms / scored.rmse - 1.0).abs() < 1e-3,
                    "{rms} {}",
                    scored.rmse
                );
            }
        }
    }
}

#[test]
fn a_page_of_nothing_is_a_page() {
    let mut result = drawn(false);
    result.series.clear();
    let page = html(&result);
    assert!(!page.contains("Is the residual noise?"));
    document(&page);
    result.models.clear();
    document(&html(&result));
}

#[test]
fn results_that_are_no_numbers_are_drawn_all_the_same() {
    let mut result = drawn(true);
    for model in &mut result.models {
        model.fit.total_pct = f64::NAN;
        model.fit.joints[0].rel_pct = f64::INFINITY;
        model.parameters[0].value = None;
        model.parameters[1].sigma = Some(f64::NAN);
        model.parameters[1].sigma_corrected = Some(f64::INFINITY);
        model.parameters[2].value = Some(0.0);
    }
    for joint in &mut result.series[1].joints {
        joint.measured.fill(f32::NAN);
        joint.models[0].predicted.fill(f32::INFINITY);
        joint.t.clear();
    }
    assert_eq!(result.models[0].name, ModelKind::Explicit);
    let page = html(&result);
    document(&page);
    assert!(page.contains("not determined") && !page.contains("NaN"));
}
