//! C99: a header and a source without allocation, state, or dependency but `math.h`.

use super::File;
use super::function::{Body, Line, Part};
use super::language::Language;
use super::signature::{Prototype, has_slip, prototypes};
use super::summary::summary;
use super::text::{number, quoted, remark};
use crate::expr::{Function, Input};
use crate::functions::Extent;
use crate::knowledge::Knowledge;
use crate::robot::Robot;

/// Words that a local variable cannot have: keywords, what `math.h` defines, our own.
const RESERVED: &str = "auto break case char const continue default do double else enum extern \
    float for goto if inline int long register restrict return short signed sizeof static struct \
    switch typedef union unsigned void volatile while bool true false class new delete this \
    sin cos fabs tanh exp pow NAN INFINITY HUGE_VAL HUGE_VALF HUGE_VALL math_errhandling \
    MATH_ERRNO MATH_ERREXCEPT FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL FP_ILOGB0 \
    FP_ILOGBNAN fpclassify isfinite isinf isnan isnormal signbit isgreater isless isunordered \
    q qd qdd slip live D P R h dh X tau M g T J row column sign bell sliding clear asm unix linux";

/// C as a [`Language`].
struct C;

impl Language for C {
    fn reserved(&self) -> Vec<String> {
        RESERVED.split_whitespace().map(str::to_owned).collect()
    }

    fn input(&self, input: Input) -> String {
        match input {
            Input::Q(joint) => format!("q[{joint}]"),
            Input::Qd(joint) => format!("qd[{joint}]"),
            Input::Qdd(joint) => format!("qdd[{joint}]"),
            Input::Slip(joint) => format!("sliding(slip, qd, {joint})"),
            Input::Parameter(column) => format!("X[{column}]"),
        }
    }

    fn trig(&self, name: &str) -> String {
        name.to_owned()
    }

    fn number(&self, value: f64) -> String {
        number(value)
    }

    fn computes_trig(&self) -> bool {
        true
    }

    fn call(&self, function: Function, x: &str, _: &str) -> String {
        match function {
            Function::Sign => format!("sign({x})"),
            Function::Abs => format!("fabs({x})"),
            Function::Tanh => format!("tanh({x})"),
            Function::Bell => format!("bell({x})"),
            Function::Power(p) => format!("pow(fabs({x}), {})", number(f64::from_bits(p))),
            Function::Sine => format!("sin({x})"),
            Function::Cosine => format!("cos({x})"),
            Function::Reciprocal => format!("(1.0 / ({x}))"),
            Function::Root => format!("sqrt({x})"),
            Function::RootOfOpposite => format!("sqrt(-({x}))"),
        }
    }
}

/// The header and the source of a robot.
pub fn c(robot: &Robot) -> [File; 2] {
    let name = &robot.mechanism.name;
    let file = |ending: &str, text| File {
        name: format!("{name}.{ending}"),
        text,
    };
    let top = "/* See the header. */\n#include \"NAME.h\"\n".replace("NAME", name);
    [file("h", header(robot)), file("c", top + &source(robot))]
}

/// The same as one text that compiles by itself.
pub fn c_in_one(robot: &Robot) -> String {
    header(robot) + "\n" + &source(robot)
}

fn header(robot: &Robot) -> String {
    let name = &robot.mechanism.name;
    let upper = name.to_ascii_uppercase();
    let mut text = String::from("/*\n");
    for line in summary(robot, "change the description and generate again") {
        text.push_str(format!(" * {}", remark(&line)).trim_end());
        text.push('\n');
    }
    text.push_str(&USE.replace("NAME", name).replace("UPPER", &upper));
    if has_slip(robot) {
        text.push_str(SLIP);
    }
    text.push_str(" */\n");
    let columns = (robot.base.parameters.iter().enumerate()).map(|(index, parameter)| {
        let comma = if index == 0 { "" } else { ",\n" };
        format!("{comma}    {upper}_X_{} = {index}", parameter.name)
    });
    text.push_str(
        &DECLARATIONS
            .replace("UPPER", &upper)
            .replace("NAME", name)
            .replace("HOW_MANY_JOINTS", &robot.mechanism.driven.to_string())
            .replace("HOW_MANY_COLUMNS", &robot.base.parameters.len().to_string())
            .replace("THE_SHA", &robot.description.hash)
            .replace("INDICES", &columns.collect::<String>()),
    );
    for signature in &prototypes(robot) {
        let doc = format!("/* {}.\n * {}. */\n", signature.summary, signature.unit);
        text.push_str(&format!("{doc}{};\n\n", prototype(robot, signature)));
    }
    text.push_str("#ifdef __cplusplus\n}\n#endif\n\n#endif\n");
    text
}

/// How to use the code; part of the comment at the top of the header.
const USE: &str = " *
 * tau = D(q, qd, qdd) X, with X in the order of the columns: X[UPPER_X_...].
 *
 *     static double D[UPPER_JOINTS][UPPER_PARAMETERS];
 *     NAME_D(q, qd, qdd, D);
 *     for (int i = 0; i < UPPER_JOINTS; i++) {
 *         tau[i] = 0.0;
 *         for (int j = 0; j < UPPER_PARAMETERS; j++) tau[i] += D[i][j] * X[j];
 *     }
 *
 * Made for control loops: a function writes every entry of its output, also those that are always
 * zero, row by row; it reads and writes nothing else, allocates nothing, keeps no state between
 * calls (any number of threads may call it) and does the same operations at every call.
 * Units are SI: q in rad or m, qd and qdd per s and s^2.
";

/// The same, of a robot whose friction has a memory.
const SLIP: &str = " *
 * slip: presliding states z/zs of the joints, which the caller integrates:
 * dz/dt = qd - |qd| z/zs. A null pointer means those of sliding, the signs of the velocities.
";

const DECLARATIONS: &str = "
#ifndef UPPER_IDENTIFICATION_MODELS
#define UPPER_IDENTIFICATION_MODELS

#ifdef __cplusplus
extern \"C\" {
#endif

/* Number of moving joints, n. */
#define UPPER_JOINTS HOW_MANY_JOINTS
/* Number of base parameters, the columns of every output. */
#define UPPER_PARAMETERS HOW_MANY_COLUMNS
/* SHA-256 of the description. */
#define UPPER_DESCRIPTION_HASH \"THE_SHA\"

/* Columns by name. */
enum {
INDICES
};

/* A base parameter. */
typedef struct {
    const char *name;
    const char *unit;
    int joint; /* from 1 */
    const char *meaning;
    const char *relation; /* standard parameters that it stands for */
} NAME_column;

/* The parameters, in the order of the columns. */
extern const NAME_column NAME_columns[UPPER_PARAMETERS];

/* Names of the joints, in the order of q. */
extern const char *const NAME_joints[UPPER_JOINTS];

/* X of the description; not a number where it gives no value. */
extern const double NAME_nominal[UPPER_PARAMETERS];

";

fn prototype(robot: &Robot, signature: &Prototype<'_>) -> String {
    let name = &robot.mechanism.name;
    let upper = name.to_ascii_uppercase();
    let parameters = signature.parameters.then_some("X");
    let inputs: String = (signature.all_signals().chain(parameters))
        .map(|input| format!("{}, ", input_array(&upper, input)))
        .collect();
    let output = output_array(&upper, signature, signature.argument);
    let function = &signature.name;
    format!("void {name}_{function}(\n    {inputs}\n    {output})").replace(", \n", ",\n")
}

/// The declaration of an argument that is read.
fn input_array(upper: &str, input: &str) -> String {
    match input {
        "X" => format!("const double X[{upper}_PARAMETERS]"),
        signal => format!("const double {signal}[{upper}_JOINTS]"),
    }
}

/// The declaration of the argument that is written.
fn output_array(upper: &str, signature: &Prototype<'_>, argument: &str) -> String {
    let extent = |extent: Extent| match extent {
        Extent::Joints => format!("[{upper}_JOINTS]"),
        Extent::Parameters => format!("[{upper}_PARAMETERS]"),
        Extent::Number(number) => format!("[{number}]"),
    };
    let rows = signature.rows.map(extent).unwrap_or_default();
    format!("double {argument}{rows}{}", extent(signature.columns))
}

fn source(robot: &Robot) -> String {
    let functions: String = prototypes(robot)
        .iter()
        .map(|signature| definition(robot, signature))
        .collect();
    // From the last to the first: a helper may ask for one before it.
    let mut code = functions;
    for (call, helper) in HELPERS.iter().rev() {
        if code.contains(call) {
            code.insert_str(0, helper);
        }
    }
    let code = format!("#include <math.h>\n\n{}{code}", tables(robot));
    code.trim_end().to_owned() + "\n"
}

/// Functions of a value that C has not, each with the call that asks for it.
const HELPERS: [(&str, &str); 3] = [
    (
        "sign(",
        "/* -1, 0 or 1. */\n\
         static double sign(double x)\n{\n    return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0 * x;\n}\n\n",
    ),
    (
        "bell(",
        "static double bell(double x)\n{\n    return exp(-x * x);\n}\n\n",
    ),
    (
        "sliding(",
        "/* The presliding state of a joint, that of sliding if there are none. */\n\
         static double sliding(const double *slip, const double *qd, int joint)\n{\n    \
         return slip ? slip[joint] : sign(qd[joint]);\n}\n\n",
    ),
];

fn tables(robot: &Robot) -> String {
    let name = &robot.mechanism.name;
    let upper = name.to_ascii_uppercase();
    let columns: String = (robot.base.parameters.iter())
        .map(|parameter| {
            format!(
                "    {{{}, {}, {},\n     {},\n     {}}},\n",
                quoted(&parameter.name),
                quoted(&parameter.unit),
                parameter.link + 1,
                quoted(&parameter.meaning),
                quoted(&parameter.relation_text())
            )
        })
        .collect();
    let joints: String = (robot.mechanism.driven().iter())
        .map(|joint| format!("    {},\n", quoted(&joint.name)))
        .collect();
    let values: String = (Knowledge::of(robot).nominal.iter())
        .zip(&robot.base.parameters)
        .map(|(value, parameter)| {
            let value = value.map_or("NAN".to_owned(), number);
            format!("    {value}, /* {} */\n", parameter.name)
        })
        .collect();
    format!(
        "const {name}_column {name}_columns[{upper}_PARAMETERS] = {{\n{columns}}};\n\n\
         const char *const {name}_joints[{upper}_JOINTS] = {{\n{joints}}};\n\n\
         const double {name}_nominal[{upper}_PARAMETERS] = {{\n{values}}};\n\n"
    )
}

fn definition(robot: &Robot, signature: &Prototype<'_>) -> String {
    let body = signature.body(robot, signature.argument, &C);
    let mut text = String::new();
    let mut calls = String::new();
    if let [only] = body.parts.as_slice() {
        calls = statements(only);
    } else {
        calls.push_str(&format!("    double live[{}];\n\n", body.live));
        for (index, part) in body.parts.iter().enumerate() {
            let name = format!("{}_{}", signature.name, index + 1);
            text.push_str(&self::part(robot, signature, &name, body.live, part));
            let given = [inputs(signature, part), vec!["live"], part.outputs()];
            calls.push_str(&format!("    {name}({});\n", given.concat().join(", ")));
        }
    }
    text.push_str(&format!("{}\n{{\n", prototype(robot, signature)));
    text.push_str(&unused(signature, &body));
    if signature.sparse {
        text.push_str(&zeros(robot, signature));
    }
    text.push_str(&calls);
    text.push_str("}\n\n");
    text
}

/// A part of a long function: it takes what it reads, and the scratch array.
fn part(robot: &Robot, signature: &Prototype<'_>, name: &str, live: usize, part: &Part) -> String {
    let upper = robot.mechanism.name.to_ascii_uppercase();
    let inputs: String = (inputs(signature, part).into_iter())
        .map(|input| format!("{}, ", input_array(&upper, input)))
        .collect();
    let outputs: String = (part.outputs().into_iter())
        .map(|output| format!(", {}", output_array(&upper, signature, output)))
        .collect();
    format!(
        "static void {name}(\n    {inputs}double live[{live}]{outputs})\n{{\n{}}}\n\n",
        statements(part)
    )
}

/// What a part reads, in the order of the function's own arguments.
fn inputs(signature: &Prototype<'_>, part: &Part) -> Vec<&'static str> {
    let parameters = signature.parameters.then_some("X");
    let all = signature.all_signals().chain(parameters);
    all.filter(|input| is_read(input, &part.inputs)).collect()
}

fn statements(part: &Part) -> String {
    let mut text = String::new();
    for trig in &part.trig {
        let angle = trig.code(|joint| format!("q[{joint}]"), number);
        for (name, function) in [(&trig.sine, "sin"), (&trig.cosine, "cos")] {
            if let Some(name) = name {
                text.push_str(&format!("    const double {name} = {function}({angle});\n"));
            }
        }
    }
    text.extend(part.lines.iter().map(line));
    text
}

/// Says of arguments that are not read that this is meant.
fn unused(signature: &Prototype<'_>, body: &Body) -> String {
    let read = body.inputs();
    let parameters = signature.parameters.then_some("X");
    let inputs = signature.all_signals().chain(parameters);
    let unread = inputs.filter(|input| !is_read(input, &read));
    unread
        .map(|input| format!("    (void)({input});\n"))
        .collect()
}

fn is_read(signal: &str, inputs: &[Input]) -> bool {
    inputs.iter().any(|input| match input {
        Input::Q(_) => signal == "q",
        Input::Qd(_) => signal == "qd",
        Input::Qdd(_) => signal == "qdd",
        Input::Slip(_) => signal == "slip" || signal == "qd",
        Input::Parameter(_) => signal == "X",
    })
}

fn zeros(robot: &Robot, signature: &Prototype<'_>) -> String {
    let upper = robot.mechanism.name.to_ascii_uppercase();
    let name = signature.argument;
    let columns = format!("for (int column = 0; column < {upper}_PARAMETERS; column++)");
    match signature.rows.is_some() {
        true => format!(
            "    for (int row = 0; row < {upper}_JOINTS; row++) {{\n        {columns} {{\n            \
             {name}[row][column] = 0.0;\n        }}\n    }}\n"
        ),
        false => format!("    {columns} {{\n        {name}[column] = 0.0;\n    }}\n"),
    }
}

fn line(line: &Line) -> String {
    match line {
        Line::Section(title) => format!("\n    /* {} */\n", remark(title)),
        Line::Load { name, place } => format!("    const double {name} = live[{place}];\n"),
        Line::Keep { name, place } => format!("    live[{place}] = {name};\n"),
        Line::Constant { name, value } => {
            format!("    const double {name} = {};\n", number(*value))
        }
        Line::Value { name, value } => format!("    const double {name} = {value};\n"),
        Line::Store {
            argument,
            row,
            column,
            value,
            parameter,
        } => {
            let row = row.map_or(String::new(), |row| format!("[{row}]"));
            let note = match parameter.as_str() {
                "" => String::new(),
                parameter => format!(" /* {parameter} */"),
            };
            format!("    {argument}{row}[{column}] = {value};{note}\n")
        }
    }
}
