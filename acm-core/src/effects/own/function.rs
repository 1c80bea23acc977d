//! Functions of expressions, and their values.
//!
//! True is 1, false 0. `sign(0)` is 0; `min` and `max` ignore NaN; `log` is natural.

/// One function or operator of at most three arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Function {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Negative,
    Not,
    Less,
    LessOrEqual,
    Equal,
    Unequal,
    And,
    Or,
    If,
    Min,
    Max,
    Abs,
    Sign,
    Sqrt,
    Exp,
    Log,
    Tanh,
    Sin,
    Cos,
    Tan,
    Atan,
    Atan2,
    /// The same number, in its own register.
    Copy,
}

/// What can be called by name, with its number of arguments.
pub const CALLED: &[(&str, Function, usize)] = &[
    ("if", Function::If, 3),
    ("min", Function::Min, 2),
    ("max", Function::Max, 2),
    ("abs", Function::Abs, 1),
    ("sign", Function::Sign, 1),
    ("sqrt", Function::Sqrt, 1),
    ("exp", Function::Exp, 1),
    ("log", Function::Log, 1),
    ("tanh", Function::Tanh, 1),
    ("sin", Function::Sin, 1),
    ("cos", Function::Cos, 1),
    ("tan", Function::Tan, 1),
    ("atan", Function::Atan, 1),
    ("atan2", Function::Atan2, 2),
    ("pow", Function::Power, 2),
];

/// The function of three arguments that is written with two others.
pub const CLAMP: &str = "clamp";

/// Every name that an expression may call, for help.
pub fn names() -> String {
    let called = CALLED.iter().map(|(name, ..)| *name);
    called.chain([CLAMP]).collect::<Vec<_>>().join(" ")
}

impl Function {
    /// Number of arguments.
    pub fn arguments(self) -> usize {
        match self {
            Function::If => 3,
            Function::Negative
            | Function::Not
            | Function::Abs
            | Function::Sign
            | Function::Sqrt
            | Function::Exp
            | Function::Log
            | Function::Tanh
            | Function::Sin
            | Function::Cos
            | Function::Tan
            | Function::Atan
            | Function::Copy => 1,
            _ => 2,
        }
    }

    /// Whether its two arguments may change places.
    pub fn is_symmetric(self) -> bool {
        matches!(self, Function::Add | Function::Multiply | Function::Min | Function::Max)
    }

    /// The function of one argument; none of those with more.
    pub fn of_one(self) -> Option<fn(f64) -> f64> {
        Some(match self {
            Function::Negative => |a| -a,
            Function::Not => |a| truth(a == 0.0),
            Function::Abs => f64::abs,
            Function::Sign => sign,
            Function::Sqrt => f64::sqrt,
            Function::Exp => f64::exp,
            Function::Log => f64::ln,
            Function::Tanh => f64::tanh,
            Function::Sin => f64::sin,
            Function::Cos => f64::cos,
            Function::Tan => f64::tan,
            Function::Atan => f64::atan,
            Function::Copy => |a| a,
            _ => return None,
        })
    }

    /// Its value; further arguments are ignored.
    pub fn of(self, [a, b, c]: [f64; 3]) -> f64 {
        match self {
            Function::Add => a + b,
            Function::Subtract => a - b,
            Function::Multiply => a * b,
            Function::Divide => a / b,
            Function::Power => power(a, b),
            Function::Less => truth(a < b),
            Function::LessOrEqual => truth(a <= b),
            Function::Equal => truth(a == b),
            Function::Unequal => truth(a != b),
            Function::And => truth(a != 0.0 && b != 0.0),
            Function::Or => truth(a != 0.0 || b != 0.0),
            Function::If => chosen(a, b, c),
            Function::Min => a.min(b),
            Function::Max => a.max(b),
            Function::Atan2 => a.atan2(b),
            one => one.of_one().map_or(f64::NAN, |of| of(a)),
        }
    }
}

/// 1 or 0.
pub fn truth(is: bool) -> f64 {
    if is { 1.0 } else { 0.0 }
}

/// −1, 0 or 1.
pub fn sign(a: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a.signum() }
}

/// `b` where `a` is true, else `c`.
pub fn chosen(a: f64, b: f64, c: f64) -> f64 {
    if a != 0.0 { b } else { c }
}

/// a^b: products for the small whole powers that formulas have.
pub fn power(a: f64, b: f64) -> f64 {
    if b == 2.0 {
        a * a
    } else if b == b.trunc() && b.abs() <= 8.0 {
        a.powi(b as i32)
    } else {
        a.powf(b)
    }
}
