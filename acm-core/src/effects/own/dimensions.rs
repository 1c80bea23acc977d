//! Dimensions of expressions: added or compared terms share one; exp, sin and the like take numbers.

use std::collections::BTreeMap;

use super::expression::{Expression, Misplaced, Node};
use super::function::Function;
use super::units::Dimension;

/// What an expression is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A comparison.
    Truth,
    /// Zero, which has any dimension.
    Zero,
    /// A quantity.
    Of(Dimension),
}

/// Dimension of every name.
pub type Names = BTreeMap<String, Dimension>;

/// What an expression is.
///
/// # Errors
/// A name that is not known, or parts that do not fit.
pub fn kind(expression: &Expression, names: &Names) -> Result<Kind, Misplaced> {
    match &expression.node {
        Node::Number(0.0) => Ok(Kind::Zero),
        Node::Number(_) => Ok(Kind::Of(Dimension::ONE)),
        Node::Name(name) => names.get(name).map(|dimension| Kind::Of(*dimension)).ok_or_else(|| {
            let known = names.keys().map(String::as_str).collect::<Vec<_>>().join(" ");
            fault(expression, format!("there is no `{name}`"), &format!("names here: {known}"))
        }),
        Node::Apply(function, arguments) => applied(expression, *function, arguments, names),
    }
}

fn applied(whole: &Expression, function: Function, parts: &[Expression], names: &Names) -> Result<Kind, Misplaced> {
    let kinds: Vec<Kind> = parts.iter().map(|part| kind(part, names)).collect::<Result<_, _>>()?;
    let quantity = |k: usize| number(&parts[k], kinds[k]);
    let plain = |k: usize| quantity(k).and_then(|dimension| pure(&parts[k], dimension));
    let truth = |k: usize| is_truth(&parts[k], kinds[k]);
    let same = |a: usize, b: usize| -> Result<Kind, Misplaced> {
        quantity(a)?;
        quantity(b)?;
        alike(whole, kinds[a], kinds[b])
    };
    Ok(match function {
        Function::Add | Function::Subtract | Function::Min | Function::Max => same(0, 1)?,
        Function::Less | Function::LessOrEqual | Function::Equal | Function::Unequal => {
            same(0, 1)?;
            Kind::Truth
        }
        Function::Multiply => {
            let product = quantity(0)?.times(quantity(1)?);
            if kinds.contains(&Kind::Zero) { Kind::Zero } else { Kind::Of(product) }
        }
        Function::Divide => {
            let ratio = quantity(0)?.over(quantity(1)?);
            if kinds[0] == Kind::Zero { Kind::Zero } else { Kind::Of(ratio) }
        }
        Function::Power => {
            plain(1)?;
            raised(whole, quantity(0)?, parts[1].value())?
        }
        Function::Sqrt => raised(whole, quantity(0)?, Some(0.5))?,
        Function::Negative | Function::Abs | Function::Copy => {
            quantity(0)?;
            kinds[0]
        }
        Function::Sign => {
            quantity(0)?;
            Kind::Of(Dimension::ONE)
        }
        Function::And | Function::Or => {
            truth(0)?;
            truth(1)?;
            Kind::Truth
        }
        Function::Not => {
            truth(0)?;
            Kind::Truth
        }
        Function::If => {
            truth(0)?;
            same(1, 2)?
        }
        Function::Atan2 => {
            same(0, 1)?;
            Kind::Of(Dimension::ONE)
        }
        Function::Exp
        | Function::Log
        | Function::Tanh
        | Function::Sin
        | Function::Cos
        | Function::Tan
        | Function::Atan => Kind::Of(plain(0)?),
    })
}

fn number(part: &Expression, kind: Kind) -> Result<Dimension, Misplaced> {
    match kind {
        Kind::Of(dimension) => Ok(dimension),
        Kind::Zero => Ok(Dimension::ONE),
        Kind::Truth => Err(fault(part, "stands a comparison where a number is needed".into(), CHOOSE)),
    }
}

fn is_truth(part: &Expression, kind: Kind) -> Result<(), Misplaced> {
    let help = "compare it: q > 0";
    if kind == Kind::Truth {
        Ok(())
    } else {
        Err(fault(part, "stands a number where a comparison is needed".into(), help))
    }
}

fn pure(part: &Expression, dimension: Dimension) -> Result<Dimension, Misplaced> {
    if dimension == Dimension::ONE {
        return Ok(dimension);
    }
    let help = "divide it by something of the same unit, such as a parameter or a constant";
    Err(fault(part, format!("stands {dimension} where a number is needed"), help))
}

fn alike(whole: &Expression, a: Kind, b: Kind) -> Result<Kind, Misplaced> {
    match (a, b) {
        (Kind::Zero, other) | (other, Kind::Zero) => Ok(other),
        (a, b) if a == b => Ok(a),
        (Kind::Of(a), Kind::Of(b)) => {
            let help = "both sides must have one unit: give a parameter or constant another unit, or multiply by one";
            Err(fault(whole, format!("one side is {a} and the other {b}"), help))
        }
        _ => Err(fault(whole, "one side is a comparison".into(), CHOOSE)),
    }
}

fn raised(whole: &Expression, base: Dimension, exponent: Option<f64>) -> Result<Kind, Misplaced> {
    if base == Dimension::ONE {
        return Ok(Kind::Of(base));
    }
    let help = "raise quantities with units to plain numbers, such as 2 or 0.5";
    let power = exponent.and_then(|exponent| base.power(exponent));
    power.map(Kind::Of).ok_or_else(|| fault(whole, format!("{base} is raised to a power that is no such number"), help))
}

const CHOOSE: &str = "write if(comparison, value, other value)";

fn fault(part: &Expression, what: String, help: &str) -> Misplaced {
    Misplaced { span: part.span, what, help: help.into() }
}
