//! The reference robots: read from beside the checkout, where they are.

use std::path::PathBuf;

use idim_codegen::catalogue::EffectKind;
use idim_codegen::describe::{
    Description, Drive, EffectSpec, Geometry, Limits, MdhRow, Motion, Quantity, Span,
};
use serde_json::Value;

/// A file of the reference data; says so where it is not there.
pub fn reference(name: &str) -> Option<Value> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../shared/reference/generators")
        .join(name);
    match std::fs::read_to_string(&path) {
        Ok(text) => Some(serde_json::from_str(&text).unwrap()),
        Err(error) => {
            println!("skipped: {name} is not beside this checkout ({error})");
            None
        }
    }
}

/// The serial robots of the geometry file with gravity along `gravity`.
pub fn description(
    name: &str,
    robot: &Value,
    gravity: [f64; 3],
    effects: &[EffectKind],
) -> Description {
    let lengths = &robot["numeric"];
    let number = |value: &Value| -> Quantity {
        let text = value.as_str().unwrap().to_owned();
        let value = match text.as_str() {
            "pi/2" => std::f64::consts::FRAC_PI_2,
            "-pi/2" => -std::f64::consts::FRAC_PI_2,
            text if text.starts_with("th") => 0.0,
            text => text.parse().ok().or(lengths[text].as_f64()).unwrap_or(0.0),
        };
        Quantity { value, text }
    };
    let rows: Vec<MdhRow> = robot["frames"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| MdhRow {
            drive: Drive::Own,
            name: format!("joint{}", frame["j"]),
            motion: if frame["sigma"] == 1 {
                Motion::Prismatic
            } else {
                Motion::Revolute
            },
            ant: frame["ant"].as_u64().unwrap() as usize,
            gamma: number(&frame["gamma"]),
            b: number(&frame["b"]),
            alpha: number(&frame["alpha"]),
            d: number(&frame["d"]),
            theta: number(&frame["theta"]),
            r: number(&frame["r"]),
            inertial: None,
            limits: Limits::default(),
            span: Span::default(),
        })
        .collect();
    let named = lengths.as_object().unwrap().iter();
    let named = named.filter_map(|(name, value)| Some((name.clone(), value.as_f64()?)));
    let named = named.collect();
    let effects = rows
        .iter()
        .flat_map(|row| {
            effects.iter().map(|&kind| EffectSpec {
                kind,
                joints: vec![row.name.clone()],
                shape: vec![],
                span: Span::default(),
            })
        })
        .collect();
    Description {
        name: name.to_lowercase(),
        hash: String::new(),
        gravity,
        lengths: named,
        geometry: Geometry::Mdh(rows),
        loops: vec![],
        effects,
        scaled: vec![],
        identify: Default::default(),
        drives: Default::default(),
        parameters: vec![],
        prior: None,
        total_mass: None,
        links: vec![],
        warnings: vec![],
        snaps: vec![],
    }
}

/// The direction that the reference gives.
pub fn gravity(robot: &Value) -> [f64; 3] {
    match robot["gravity"][2].as_str() {
        Some("G3") => [0.0, 0.0, -9.81],
        _ => [0.0; 3],
    }
}
