//! The planar SCARA of Gautier 1996, Table 1.

use super::hand_written::scara;
use super::reading::{json, recording};
use crate::identify::{Options, identify};
use crate::settings::{Edges, Weights};

#[test]
fn scara_reproduces_table_1() {
    let Some(log) = recording("reference/scara_table1_log.csv.gz", 2, 100.0) else {
        return;
    };
    let Some(table) = json("reference/scara_table1.json") else {
        return;
    };
    let options = Options {
        fq_hz: Some(8.0),
        order: Some(4),
        nd: Some(10),
        trim: Some(10),
        edges: Some(Edges::Matlab),
        prefilter_torque: Some(true),
        weights: Some(Weights::None),
        ..Options::default()
    };
    let found = identify(&scara(), &[log], &[], &options, &()).unwrap();
    assert_eq!(found.models.len(), 3);
    for model in &found.models {
        let expected = &table["expected"][model.name.name()];
        assert_eq!(model.rows as u64, expected["rows"].as_u64().unwrap());
        let condition = expected["cond"].as_f64().unwrap();
        assert!(
            (model.condition / condition - 1.0).abs() < 1e-4,
            "{}",
            model.condition
        );
        for parameter in &model.parameters {
            let name = parameter.name.replace("FV", "Fv").replace("FS", "Fs");
            let x = expected["X_hat"][&name].as_f64().unwrap();
            let error = parameter.value.unwrap() / x - 1.0;
            assert!(error.abs() < 1e-6, "{:?} {name}: {error:e}", model.name);
        }
    }
}
