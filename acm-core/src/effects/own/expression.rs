//! Expressions: text in, a tree out, with the place of every part in the text.
//!
//! | binds          | operators                       |
//! | -------------- | ------------------------------- |
//! | most           | `^`, from the right             |
//! |                | `-` and `!` before a value      |
//! |                | `*` `/`                         |
//! |                | `+` `-`                         |
//! |                | `<` `<=` `>` `>=` `==` `!=`     |
//! |                | `&&`                            |
//! | least          | `||`                            |
//!
//! So `-x^2` is −(x²), as on paper. Pratt (1973), Top down operator precedence, POPL.

use super::function::{CALLED, CLAMP, Function, names};

/// A part of an expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    /// What it is.
    pub node: Node,
    /// Its first byte in the text, and the byte after its last.
    pub span: [usize; 2],
}

/// What a part of an expression is.
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    /// A number.
    Number(f64),
    /// A signal, state, parameter or constant.
    Name(String),
    /// A function of parts.
    Apply(Function, Vec<Expression>),
}

/// What is wrong with a part of a text, and what to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Misplaced {
    /// First byte, and the byte after the last.
    pub span: [usize; 2],
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub help: String,
}

/// Longest text, in bytes, and deepest nesting of brackets; longer ones must be split into states.
const LONGEST: usize = 1000;
const DEEPEST: usize = 50;

/// Reads an expression.
///
/// # Errors
/// Text that is none.
pub fn parse(text: &str) -> Result<Expression, Misplaced> {
    if text.len() > LONGEST {
        let help = "split it: a state may hold a part of it".into();
        return Err(Misplaced { span: [0, 0], what: format!("has more than {LONGEST} characters"), help });
    }
    let mut parser = Parser { text, at: 0, depth: 0 };
    let expression = parser.expression(0)?;
    match parser.peek() {
        None => Ok(expression),
        Some(_) => Err(parser.unexpected("an operator, or the end")),
    }
}

impl Expression {
    /// A function of expressions.
    pub fn apply(function: Function, arguments: Vec<Expression>) -> Self {
        let from = arguments.first().map_or(0, |first| first.span[0]);
        let to = arguments.last().map_or(0, |last| last.span[1]);
        Self { node: Node::Apply(function, arguments), span: [from, to] }
    }

    /// A number of no place.
    pub fn number(value: f64) -> Self {
        Self { node: Node::Number(value), span: [0, 0] }
    }

    /// Its value where it has no names.
    pub fn value(&self) -> Option<f64> {
        match &self.node {
            Node::Number(value) => Some(*value),
            Node::Name(_) => None,
            Node::Apply(function, arguments) => {
                let mut values = [0.0; 3];
                for (value, argument) in values.iter_mut().zip(arguments) {
                    *value = argument.value()?;
                }
                Some(function.of(values))
            }
        }
    }

    /// Whether one of its names is such.
    pub fn has(&self, is: &impl Fn(&str) -> bool) -> bool {
        match &self.node {
            Node::Number(_) => false,
            Node::Name(name) => is(name),
            Node::Apply(_, arguments) => arguments.iter().any(|argument| argument.has(is)),
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

/// Binary operators: text, precedence, function, whether the sides are swapped. Longer ones first.
const BETWEEN: &[(&str, u8, Function, bool)] = &[
    ("||", 1, Function::Or, false),
    ("&&", 2, Function::And, false),
    ("<=", 3, Function::LessOrEqual, false),
    (">=", 3, Function::LessOrEqual, true),
    ("==", 3, Function::Equal, false),
    ("!=", 3, Function::Unequal, false),
    ("<", 3, Function::Less, false),
    (">", 3, Function::Less, true),
    ("+", 4, Function::Add, false),
    ("-", 4, Function::Subtract, false),
    ("*", 5, Function::Multiply, false),
    ("/", 5, Function::Divide, false),
    ("^", 7, Function::Power, false),
];

/// Precedence of a sign before a value, and of a power.
const SIGN: u8 = 6;
const POWER: u8 = 7;
/// Precedence of a comparison; a second one after it needs brackets.
const COMPARISON: u8 = 3;

impl Parser<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn peek(&mut self) -> Option<char> {
        self.at += self.rest().len() - self.rest().trim_start().len();
        self.rest().chars().next()
    }

    fn take(&mut self, word: &str) -> bool {
        self.peek();
        let is = self.rest().starts_with(word);
        self.at += if is { word.len() } else { 0 };
        is
    }

    fn expression(&mut self, least: u8) -> Result<Expression, Misplaced> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let what = format!("has more than {DEEPEST} parts within each other");
            return Err(Misplaced { span: [self.at, self.at], what, help: "split it into states".into() });
        }
        let mut left = self.value()?;
        loop {
            self.peek();
            let Some((word, binds, function, turned)) =
                BETWEEN.iter().copied().find(|(word, ..)| self.rest().starts_with(word))
            else {
                break;
            };
            if binds < least {
                break;
            }
            self.at += word.len();
            // A power is right-associative, all others are left-associative.
            let right = self.expression(if binds == POWER { SIGN } else { binds + 1 })?;
            let span = [left.span[0], right.span[1]];
            let sides = if turned { vec![right, left] } else { vec![left, right] };
            left = Expression { node: Node::Apply(function, sides), span };
            if binds == COMPARISON && self.compares() {
                return Err(self.unexpected("`&&` between two comparisons"));
            }
        }
        self.depth -= 1;
        Ok(left)
    }

    fn compares(&mut self) -> bool {
        self.peek();
        BETWEEN.iter().any(|(word, binds, ..)| *binds == COMPARISON && self.rest().starts_with(word))
    }

    fn value(&mut self) -> Result<Expression, Misplaced> {
        let first = self.peek();
        let from = self.at;
        match first {
            Some('-') => self.signed(from, Function::Negative),
            Some('!') => self.signed(from, Function::Not),
            Some('(') => {
                self.at += 1;
                let inner = self.expression(0)?;
                self.close()?;
                Ok(Expression { node: inner.node, span: [from, self.at] })
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(from),
            Some(c) if c.is_ascii_alphabetic() || c == '_' => self.named(from),
            _ => Err(self.unexpected("a number, a name or `(`")),
        }
    }

    fn signed(&mut self, from: usize, function: Function) -> Result<Expression, Misplaced> {
        self.at += 1;
        let inner = self.expression(SIGN)?;
        let span = [from, inner.span[1]];
        Ok(Expression { node: Node::Apply(function, vec![inner]), span })
    }

    fn close(&mut self) -> Result<(), Misplaced> {
        if self.take(")") { Ok(()) } else { Err(self.unexpected("`)`")) }
    }

    fn number(&mut self, from: usize) -> Result<Expression, Misplaced> {
        let bytes = self.text.as_bytes();
        let digits = |mut at: usize| {
            while bytes.get(at).is_some_and(|b| b.is_ascii_digit() || *b == b'.') {
                at += 1;
            }
            at
        };
        let mut to = digits(from);
        if bytes.get(to).is_some_and(|b| matches!(b, b'e' | b'E')) {
            let sign = usize::from(bytes.get(to + 1).is_some_and(|b| matches!(b, b'+' | b'-')));
            to = if bytes.get(to + 1 + sign).is_some_and(u8::is_ascii_digit) { digits(to + 1 + sign) } else { to };
        }
        self.at = to;
        let value = self.text[from..to].parse::<f64>().ok().filter(|value| value.is_finite());
        let glued = self.rest().starts_with(|c: char| c.is_alphanumeric() || c == '_');
        match value {
            Some(value) if !glued => Ok(Expression { node: Node::Number(value), span: [from, to] }),
            Some(_) => Err(self.unexpected("`*` between a number and a name")),
            None => Err(Misplaced {
                span: [from, to],
                what: format!("`{}` is no number", &self.text[from..to]),
                help: "write it like 0.25 or 3e-4".into(),
            }),
        }
    }

    fn named(&mut self, from: usize) -> Result<Expression, Misplaced> {
        let length = self.rest().find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
        self.at += length.unwrap_or(self.rest().len());
        let name = self.text[from..self.at].to_string();
        if !self.take("(") {
            let span = [from, from + name.len()];
            return Ok(Expression { node: Node::Name(name), span });
        }
        let mut arguments = vec![self.expression(0)?];
        while self.take(",") {
            arguments.push(self.expression(0)?);
        }
        self.close()?;
        let span = [from, self.at];
        called(&name, arguments, span)
    }

    fn unexpected(&mut self, wanted: &str) -> Misplaced {
        let found = self.peek();
        let to = self.at + found.map_or(0, char::len_utf8);
        let what = found.map_or("it ends".to_string(), |found| format!("`{found}` stands"));
        let help = format!("write numbers, names, + - * / ^, comparisons, and {}", names());
        Misplaced { span: [self.at, to], what: format!("{what} where {wanted} is expected"), help }
    }
}

/// The function of a name, of these arguments.
fn called(name: &str, arguments: Vec<Expression>, span: [usize; 2]) -> Result<Expression, Misplaced> {
    let found = arguments.len();
    let apply = |function, arguments| Expression { node: Node::Apply(function, arguments), span };
    let wrong = |needed: &str| {
        let what = format!("{name} has {found} arguments");
        Misplaced { span, what, help: format!("it takes {needed}") }
    };
    if name == CLAMP {
        let [value, low, high] = <[Expression; 3]>::try_from(arguments).map_err(|_| wrong("3: value, low, high"))?;
        return Ok(apply(Function::Min, vec![apply(Function::Max, vec![value, low]), high]));
    }
    let Some((_, function, needed)) = CALLED.iter().copied().find(|(known, ..)| *known == name) else {
        let what = format!("there is no function `{name}`");
        return Err(Misplaced { span, what, help: format!("functions: {}", names()) });
    };
    if matches!(function, Function::Min | Function::Max) && found > 2 {
        let folded = arguments.into_iter().reduce(|a, b| apply(function, vec![a, b]));
        return folded.ok_or_else(|| wrong("2 or more"));
    }
    if found == needed { Ok(apply(function, arguments)) } else { Err(wrong(&needed.to_string())) }
}

#[cfg(test)]
mod tests {
    use exmex::prelude::*;
    use exmex::{FlatEx, parse as exmex_parse};
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;
    use crate::effects::own::affine::affine;
    use crate::effects::own::program::{Class, Scope, Writer, run};

    /// Through the registers, at these values of a, b, x.
    fn value(text: &str, at: [f64; 3]) -> f64 {
        let expression = parse(text).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
        let mut writer = Writer::default();
        let scope: Scope = ["a", "b", "x"].map(|name| (name.to_string(), writer.register(Class::Sample))).into();
        let result = writer.expression(&expression, &scope);
        let program = writer.finish();
        let mut buffer = vec![0.0; program.registers()];
        buffer[..3].copy_from_slice(&at);
        program.numbers.iter().for_each(|&(register, value)| buffer[register] = value);
        run(program.of(Class::Sample), &mut buffer, 1, 0..1);
        buffer[result]
    }

    /// Oracle: arithmetic on paper.
    #[test]
    fn precedence_and_functions() {
        let at = [2.0, 3.0, -4.0];
        for (text, expected) in [
            ("-a^2", -4.0),
            ("a^-1", 0.5),
            ("a^b^a", 512.0),
            ("2*a^2/b", 8.0 / 3.0),
            ("a - b - x", 3.0),
            ("a/b/a", 1.0 / 3.0),
            ("-x*-a", -8.0),
            ("1 - -a", 3.0),
            ("1 - (-(a + 0.125 + 0.125))", 3.25),
            ("if(a > b || !(x >= 0) && b <= 3, 1, 2)", 1.0),
            ("if(a == 2, if(x != -4, 1, 7), 2)", 7.0),
            ("clamp(x, -a, a)", -2.0),
            ("min(a, b, x) + max(a, b, x)", -1.0),
            ("sign(x) + sign(0) + abs(x)", 3.0),
            ("atan2(a, 0)", std::f64::consts::FRAC_PI_2),
            ("pow(a, 3) + sqrt(4) + log(exp(1.5))", 11.5),
            ("1.5e-1*a + .5", 0.8),
            ("a^9", 512.0),
        ] {
            assert!((value(text, at) - expected).abs() < 1e-14, "{text}: {}", value(text, at));
        }
    }

    fn formula() -> impl Strategy<Value = String> {
        let leaf = "[abx]";
        leaf.prop_recursive(5, 40, 3, |inner| {
            prop_oneof![
                (inner.clone(), inner.clone(), "[-+*/]").prop_map(|(a, b, o)| format!("({a}) {o} ({b})")),
                (inner.clone(), inner.clone(), inner.clone(), "[-+*/]", "[-+*/]")
                    .prop_map(|(a, b, c, o, p)| format!("({a}) {o} ({b}) {p} ({c})")),
                inner.clone().prop_map(|a| format!("({a})^2 * 3")),
                (inner, "sin|cos|tanh|atan|abs|sqrt|exp").prop_map(|(a, f)| format!("{f}({a})")),
            ]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 400, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

        /// Oracle: another parser, exmex. Rounding may differ where it associates otherwise. Sums of numbers are left to
        /// paper: exmex 0.21 makes 0.75 of 1 - (-(a + 0.125 + 0.125)) at a = 0.5.
        #[test]
        fn another_parser_agrees(text in formula(), a in 0.5f64..2.0, b in -2.0f64..2.0, x in -2.0f64..2.0) {
            let other: FlatEx<f64> = exmex_parse(&text).unwrap();
            let at = |name: &String| match name.as_str() { "a" => a, "b" => b, _ => x };
            let values: Vec<f64> = other.var_names().iter().map(at).collect();
            let expected = other.eval(&values).unwrap();
            let found = value(&text, [a, b, x]);
            let alike = (found - expected).abs() <= 1e-6 * expected.abs().max(1.0);
            prop_assert!(alike || !expected.is_finite() || expected.abs() > 1e6, "{text}: {found} {expected}");
        }

        /// Oracle: exmex's symbolic derivative of an expression that is linear in x is its coefficient.
        #[test]
        fn a_coefficient_is_the_derivative(rest in formula(), factor in formula(), a in 0.5f64..2.0, b in 0.5f64..2.0) {
            let without = |text: String| text.replace('x', "b").replace("ebp", "exp").replace("abs", "sin");
            let (rest, factor) = (without(rest), without(factor));
            let text = format!("({rest}) - ({factor}) * (x - a) / 3 + x");
            let terms = affine(&parse(&text).unwrap(), &|name: &str| name == "x").unwrap();
            let whole: FlatEx<f64> = exmex_parse(&text).unwrap();
            let x = whole.var_names().iter().position(|name| name == "x").unwrap();
            let slope = whole.partial(x).unwrap();
            let at = |name: &String| match name.as_str() { "a" => a, "b" => b, _ => 1.3 };
            let values: Vec<f64> = slope.var_names().iter().map(at).collect();
            let expected = slope.eval(&values).unwrap();
            let shown = coefficient(&terms[&Some("x".to_string())], a, b);
            let alike = (shown - expected).abs() <= 1e-6 * expected.abs().max(1.0);
            prop_assert!(alike || !expected.is_finite() || expected.abs() > 1e6, "{text}: {shown} {expected}");
        }
    }

    fn coefficient(expression: &Expression, a: f64, b: f64) -> f64 {
        match &expression.node {
            Node::Number(value) => *value,
            Node::Name(name) => {
                if name == "a" {
                    a
                } else {
                    b
                }
            }
            Node::Apply(function, parts) => {
                let mut values = [0.0; 3];
                values.iter_mut().zip(parts).for_each(|(v, part)| *v = coefficient(part, a, b));
                function.of(values)
            }
        }
    }
}
