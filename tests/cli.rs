//! The command line as a user meets it: what it prints, what it writes, how it fails.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn idim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_idim"))
        .args(arguments)
        .output()
        .unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    // Messages may be wrapped for the terminal: compare words.
    let text = String::from_utf8(output.stderr.clone()).unwrap();
    text.split_whitespace()
        .filter(|word| *word != "│")
        .collect::<Vec<_>>()
        .join(" ")
}

#[track_caller]
fn fails(arguments: &[&str], status: i32, pieces: &[&str]) {
    let output = idim(arguments);
    let message = stderr(&output);
    assert_eq!(
        output.status.code(),
        Some(status),
        "{arguments:?}: {message}"
    );
    assert!(
        output.stdout.is_empty(),
        "{arguments:?} printed: {}",
        stdout(&output)
    );
    for piece in pieces {
        assert!(
            message.contains(piece),
            "{arguments:?}: no `{piece}` in: {message}"
        );
    }
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }
    fn file(&self, name: &str, text: &str) -> String {
        let path = self.0.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    }
    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

/// A 1-joint slide with q = sin(t) and the torque of 2 kg with friction 3, offset 0.5.
fn slide_log(rows: usize, change: impl Fn(usize, &mut [String; 3])) -> String {
    let mut text = "t,q1,tau1\n".to_owned();
    for row in 0..rows {
        let t = row as f64 * 0.01;
        let (q, qd, qdd) = (t.sin(), t.cos(), -t.sin());
        let tau = 2.0 * qdd + 3.0 * qd + 0.7 * qd.signum() + 0.5;
        let mut fields = [format!("{t:.2}"), format!("{q}"), format!("{tau}")];
        change(row, &mut fields);
        text.push_str(&(fields.join(",") + "\n"));
    }
    text
}

#[test]
fn describe_as_json_has_the_documented_fields() {
    let output = idim(&["describe", "rx90", "--json", "-"]);
    assert!(output.status.success());
    let json: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(json["robot"], "rx90");
    assert_eq!(json["joints"][0]["kind"], "revolute");
    assert!(json["rank_gap"].as_f64().unwrap() > 1e6);
    let parameters = json["base_parameters"].as_array().unwrap();
    let inertial = parameters
        .iter()
        .filter(|p| p["kind"] == "inertial")
        .count();
    assert_eq!(inertial, 36);
    assert_eq!(parameters[0]["name"], "ZZR1");
    let operations = &json["operations"]["explicit"];
    assert!(operations["mul"].as_u64().unwrap() > 0 && operations["trig"].as_u64().unwrap() > 0);
    assert!(json["snaps"].is_array() && json["warnings"].is_array());
}

#[test]
fn describe_for_people_names_joints_parameters_and_operations() {
    let text = stdout(&idim(&["describe", "tx40"]));
    for piece in [
        "80 base parameters",
        "q6 + pi",
        "ZZ1 + YY2",
        "IAM6",
        "P+R implicit",
    ] {
        assert!(text.contains(piece), "no `{piece}` in:\n{text}");
    }
}

#[test]
fn describe_of_an_arm_of_six_axes_is_understood_in_a_minute() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/describe/six_axes.urdf");
    insta::assert_snapshot!(stdout(&idim(&["describe", path])));
}

#[test]
fn describe_names_the_columns_that_stand_on_a_detail() {
    let folder = Folder::new();
    let arm = |offset: &str| {
        let text = format!(
            "name = \"arm\"\neffects = []\ngravity = [0, 0, 0]\n\
             [[joint]]\nname = \"a\"\nkind = \"revolute\"\n\
             [[joint]]\nname = \"b\"\nkind = \"revolute\"\nd = {offset}\n"
        );
        folder.file("arm.toml", &text)
    };
    let near = stdout(&idim(&["describe", &arm("1e-6")]));
    for piece in [
        "MX2, MY2 stand on a detail",
        "is 3e5 times\n  smaller",
        "do without their values",
    ] {
        assert!(near.contains(piece), "no `{piece}` in:\n{near}");
    }
    let json = stdout(&idim(&["describe", &arm("1e-6"), "--json", "-"]));
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["detail"]["columns"], serde_json::json!(["MX2", "MY2"]));
    let far = stdout(&idim(&["describe", &arm("0.3")]));
    assert!(!far.contains("detail"), "{far}");
}

#[test]
fn generate_writes_the_same_code_to_a_file_and_to_standard_output() {
    let folder = Folder::new();
    let path = folder.path("scara.rs");
    let written = idim(&["generate", "scara", "-o", &path.display().to_string()]);
    assert!(written.status.success() && written.stdout.is_empty());
    let printed = stdout(&idim(&["generate", "scara"]));
    assert_eq!(std::fs::read_to_string(path).unwrap(), printed);
    assert!(printed.starts_with("// @generated by idim-codegen"));
}

#[test]
fn generate_writes_c_and_python_into_a_folder_that_it_makes() {
    let folder = Folder::new();
    let out = folder.path("made/here/").display().to_string();
    for language in ["c", "python", "rust"] {
        let written = idim(&["generate", "scara", "--language", language, "-o", &out]);
        assert!(written.status.success() && written.stdout.is_empty());
    }
    let read = |file: &str| std::fs::read_to_string(Path::new(&out).join(file)).unwrap();
    assert!(read("scara.h").contains("void scara_D("));
    assert!(read("scara.c").starts_with("/* See the header. */\n#include \"scara.h\""));
    assert!(read("scara.rs").starts_with("// @generated"));
    let printed = stdout(&idim(&["generate", "scara", "--language", "python"]));
    assert_eq!(read("scara.py"), printed);
    let printed = stdout(&idim(&["generate", "scara", "--language", "c"]));
    assert!(!printed.contains("scara.h\""), "one text stands alone");
    let file = format!("{out}scara.h");
    fails(
        &["generate", "scara", "--language", "c", "-o", &file],
        2,
        &["2 files", "name a folder"],
    );
}

#[test]
fn generate_par_is_a_robot_like_any_other() {
    let folder = Folder::new();
    let path = folder.path("puma560.par").display().to_string();
    let written = idim(&["generate", "puma560", "--language", "par", "-o", &path]);
    assert!(written.status.success() && written.stdout.is_empty());
    let text = stdout(&idim(&["describe", &path]));
    assert!(text.contains("puma560") && text.contains("ZZR1"), "{text}");
}

#[test]
fn demo_shows_three_models_and_writes_its_log_and_result() {
    let folder = Folder::new();
    let out = folder.path("demo").display().to_string();
    let output = idim(&["demo", "--folder", &out]);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = stdout(&output);
    for piece in ["explicit", "implicit", "power", "ZZR1", "Cond(W)", "800"] {
        assert!(text.contains(piece), "no `{piece}` in:\n{text}");
    }
    let log = folder.path("demo/scara.csv").display().to_string();
    let again = idim(&["identify", "scara", &log, "--json", "-"]);
    let json: Value = serde_json::from_str(&stdout(&again)).unwrap();
    let saved = std::fs::read_to_string(folder.path("demo/result.json")).unwrap();
    let saved: Value = serde_json::from_str(&saved).unwrap();
    assert_eq!(
        json["models"][0]["parameters"],
        saved["models"][0]["parameters"]
    );
}

#[test]
fn demo_hides_an_effect_and_finds_it_from_the_files_alone() {
    let folder = Folder::new();
    let out = folder.path("demo").display().to_string();
    let output = idim(&["demo", "--folder", &out]);
    let text = stdout(&output);
    assert!(
        text.contains("one effect is missing, and it explains the gap"),
        "{text}"
    );
    let read = |name: &str| -> Value {
        let text = std::fs::read_to_string(folder.path(&format!("demo/{name}"))).unwrap();
        serde_json::from_str(&text).unwrap()
    };
    let found = read("diagnosis.json");
    let effect = &found["effects"][0];
    assert_eq!(
        (effect["effect"].as_str(), &effect["joints"][0]),
        (Some("stribeck"), &1.into())
    );
    let (value, sigma) = (
        &effect["parameters"][0]["value"],
        &effect["parameters"][0]["sigma"],
    );
    let (value, sigma) = (value.as_f64().unwrap(), sigma.as_f64().unwrap());
    assert!((value - 0.4).abs() < 3.0 * sigma, "{value} +- {sigma}");
    assert!((effect["shape"]["velocity"].as_f64().unwrap() - 0.2).abs() < 0.01);
    let total = |when: &str| found["gap"]["torque"][when]["total_pct"].as_f64().unwrap();
    assert!(total("after") < 0.3 * total("before"));
    // The command that it prints finds the same, and the written description has the parameter.
    let log = |name: &str| folder.path(&format!("demo/{name}")).display().to_string();
    let again = idim(&[
        "diagnose",
        "scara",
        &log("train.csv"),
        "--validate",
        &log("valid.csv"),
        "--fq",
        "50",
        "--predictions",
        &log("out"),
        "--json",
        "-",
    ]);
    let again: Value = serde_json::from_str(&stdout(&again)).unwrap();
    assert_eq!(again["effects"], found["effects"]);
    // In closed loop the robot with the effect goes where the log went.
    assert_eq!(again["gap"]["simulation"], found["gap"]["simulation"]);
    let shoulder = |when: &str| found["gap"]["simulation"][when]["rms"][0].as_f64().unwrap();
    assert!(shoulder("after") < 0.2 * shoulder("before"));
    let file = std::fs::File::open(folder.path("demo/out/valid_after.csv.gz")).unwrap();
    let mut head = String::new();
    let mut text = std::io::BufReader::new(flate2::read::GzDecoder::new(file));
    std::io::BufRead::read_line(&mut text, &mut head).unwrap();
    assert_eq!(head, "t,tau1,tau2,q1,q2\n");
    let written = log("scara_found.toml");
    let identified = idim(&[
        "identify",
        &written,
        &log("train.csv"),
        "--fq",
        "50",
        "--json",
        "-",
    ]);
    let identified: Value = serde_json::from_str(&stdout(&identified)).unwrap();
    let parameters = identified["models"][0]["parameters"].as_array().unwrap();
    let own = parameters.iter().find(|p| p["name"] == "FST1").unwrap();
    assert!((own["value"].as_f64().unwrap() - 0.4).abs() < 0.03, "{own}");
}

#[test]
fn identify_of_a_path_recovers_what_made_the_log_and_predicts_it() {
    let folder = Folder::new();
    let robot = folder.file("slide.toml", SLIDE);
    let log = folder.file("run.csv", &slide_log(4000, |_, _| {}));
    let predictions = folder.path("out");
    let output = idim(&[
        "identify",
        &robot,
        &log,
        "--validate",
        &format!("{log}@10..30"),
        "--predictions",
        &predictions.display().to_string(),
        "--json",
        "-",
        "--fq",
        "8",
        "--nd",
        "5",
    ]);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let explicit = &json["models"][0];
    assert_eq!(explicit["name"], "explicit");
    for (name, truth, tolerance) in [
        ("M1", 2.0, 0.01),
        ("FV1", 3.0, 0.01),
        ("FS1", 0.7, 0.01),
        ("OFF1", 0.5, 0.01),
    ] {
        let parameters = explicit["parameters"].as_array().unwrap();
        let found = parameters.iter().find(|p| p["name"] == name).unwrap();
        let value = found["value"].as_f64().unwrap();
        assert!((value - truth).abs() < tolerance, "{name}: {value}");
        assert!(found["sigma"].is_number() && found["sigma_pct"].is_number());
        assert!(found.get("sigma_corrected").is_some() && found["relation"] == name);
    }
    assert!(explicit["condition"].is_number() && explicit["rank"] == 4);
    assert!(explicit["validation"][0]["total_pct"].as_f64().unwrap() < 2.0);
    for model in ["explicit", "implicit", "power"] {
        let file = predictions.join(format!("run_{model}.csv.gz"));
        assert!(file.is_file(), "{}", file.display());
    }
}

const SLIDE: &str = "name = \"slide\"\ngravity = [0.0, 9.81, 0.0]\n\
    effects = [\"viscous\", \"coulomb\", \"offset\"]\n\
    [[joint]]\nname = \"carriage\"\nkind = \"prismatic\"\n";

#[test]
fn robots_that_are_not_there_are_named_with_those_that_are() {
    fails(
        &["describe", "skara"],
        2,
        &["no robot called `skara`", "built in are emps, panda"],
    );
    fails(
        &["describe", "nowhere/arm.urdf"],
        1,
        &["arm.urdf", "No such file"],
    );
    let bad = ["identify", "scara"];
    fails(&bad, 2, &["required", "LOG"]);
}

#[test]
fn descriptions_with_mistakes_show_file_line_column_and_hint() {
    let folder = Folder::new();
    let robot = folder.file("bad.toml", &SLIDE.replace("effects", "efects"));
    fails(
        &["describe", &robot],
        1,
        &["bad.toml:3:1", "efects", "effects"],
    );
    let zero_axis = "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\n\
        <joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>\n\
        <axis xyz=\"0 0 0\"/></joint></robot>";
    let robot = folder.file("zero.urdf", zero_axis);
    fails(&["describe", &robot], 1, &["zero.urdf:3", "axis", "j"]);
}

#[test]
fn logs_that_cannot_be_used_say_what_and_where() {
    let folder = Folder::new();
    let robot = folder.file("slide.toml", SLIDE);
    let missing = folder.path("none.csv").display().to_string();
    fails(&["identify", &robot, &missing], 1, &["none.csv"]);
    let case = |name: &str, text: &str, pieces: &[&str]| {
        let log = folder.file(name, text);
        fails(
            &["identify", &robot, &log, "--fq", "8", "--nd", "5"],
            1,
            pieces,
        );
    };
    let clean = slide_log(1000, |_, _| {});
    case(
        "column.csv",
        &clean.replace("q1", "p1"),
        &["column.csv", "q1", "carriage"],
    );
    let nan = slide_log(1000, |row, fields| {
        if row % 3 == 0 {
            fields[1] = "nan".into();
        }
    });
    case("nan.csv", &nan, &["q1", "334", "0, 3, 6"]);
    let back = slide_log(1000, |row, fields| {
        if row == 500 {
            fields[0] = "1.0".into();
        }
    });
    case("back.csv", &back, &["row 500", "line 502"]);
    case("short.csv", &slide_log(30, |_, _| {}), &["short.csv"]);
    let part = folder.file("run.csv", &clean);
    fails(
        &["identify", &robot, &format!("{part}@7..5")],
        2,
        &["7", "5"],
    );
}

#[test]
fn identification_without_enough_equations_says_how_many_are_missing() {
    let folder = Folder::new();
    let robot = folder.file("slide.toml", SLIDE);
    let log = folder.file("run.csv", &slide_log(300, |_, _| {}));
    let arguments = [
        "identify", &robot, &log, "--fq", "8", "--nd", "100", "--trim", "0",
    ];
    fails(&arguments, 1, &["3 equations", "4"]);
}

#[test]
fn joint_that_rests_is_a_warning_that_names_its_parameters() {
    let folder = Folder::new();
    let robot = folder.file("two.toml", TWO);
    let mut text = "t,q1,q2,tau1,tau2\n".to_owned();
    for row in 0..3000 {
        let t = f64::from(row) * 0.01;
        text.push_str(&format!(
            "{t:.2},{},0.2,{},0.1\n",
            t.sin(),
            -t.sin() + t.cos()
        ));
    }
    let log = folder.file("run.csv", &text);
    let output = idim(&[
        "identify", &robot, &log, "--json", "-", "--fq", "8", "--nd", "5",
    ]);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let warnings = json["warnings"].to_string();
    assert!(
        warnings.contains("elbow") && warnings.contains("FV2"),
        "{warnings}"
    );
    let parameters = json["models"][0]["parameters"].as_array().unwrap();
    let value = |name: &str| &parameters.iter().find(|p| p["name"] == name).unwrap()["value"];
    assert!(value("FV2").is_null() && value("FV1").is_number());
}

const TWO: &str = "name = \"two\"\ngravity = [0.0, 0.0, 0.0]\n\
    effects = [\"viscous\", \"coulomb\"]\n\
    [[joint]]\nname = \"shoulder\"\nkind = \"revolute\"\n\
    [[joint]]\nname = \"elbow\"\nkind = \"revolute\"\nd = 0.5\n";

#[test]
fn outputs_are_whole_or_not_there() {
    let folder = Folder::new();
    let nowhere = folder.path("no/such/folder/scara.rs");
    let output = idim(&["generate", "scara", "-o", &nowhere.display().to_string()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(!Path::new(&nowhere).exists());
    fails(
        &["identify", "scara", "x.csv", "--predictions", "out"],
        2,
        &["--predictions without --validate", "name the log"],
    );
}
