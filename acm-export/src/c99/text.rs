//! Pieces of C: numbers that parse to the same bits, tables, and safe comments.

use acm_kernels::{Body, Shape};
use acm_stream::{AverageParts, MemberParts, Parts, StateRule};

use super::HEAD;
use crate::Origin;

/// Characters in a line of a table.
const WIDTH: usize = 110;

/// Returns a double that reads back as the same bits.
pub fn double(value: f64) -> String {
    format!("{value:?}")
}

/// Returns a float that reads back as the same bits.
pub fn float(value: f32) -> String {
    format!("{value:?}f")
}

/// Writes the items of an initialiser, several a line, indented.
pub fn items(items: impl IntoIterator<Item = String>) -> String {
    let (mut text, mut line) = (String::new(), String::from("   "));
    for item in items {
        if line.len() + item.len() + 2 > WIDTH {
            text.push_str(&line);
            text.push('\n');
            line = String::from("   ");
        }
        line.push(' ');
        line.push_str(&item);
        line.push(',');
    }
    text + &line + "\n"
}

/// Writes `static const double name[n] = {…};`
pub fn doubles(name: &str, values: &[f64]) -> String {
    format!("static const double {name}[{}] = {{\n{}}};\n", values.len(), items(values.iter().map(|v| double(*v))))
}

/// Writes `static const int name[n] = {…};`
pub fn integers(name: &str, values: &[usize]) -> String {
    format!("static const int {name}[{}] = {{\n{}}};\n", values.len(), items(values.iter().map(ToString::to_string)))
}

/// Returns a table of rows.
pub fn rows(kind: &str, name: &str, rows: &[Vec<String>]) -> String {
    let width = rows.first().map_or(0, Vec::len);
    let lines: String = rows.iter().map(|row| format!("    {{ {} }},\n", row.join(", "))).collect();
    format!("static const {kind} {name}[{}][{width}] = {{\n{lines}}};\n", rows.len())
}

/// Returns a name as it may stand in a comment.
pub fn plain(name: &str) -> String {
    let ascii = |c: char| match c {
        '²' => "^2".into(),
        '³' => "^3".into(),
        '·' => "*".into(),
        '°' => "deg".into(),
        'µ' | 'μ' => "u".into(),
        c if c.is_ascii_graphic() || c == ' ' => c.to_string(),
        _ => "?".into(),
    };
    name.chars()
        .map(ascii)
        .collect::<String>()
        .replace("*/", "* /")
        .replace("/*", "/ *")
        .replace('$', "?")
        .replace("??", "?")
}

/// Returns the head of a part of the source.
pub fn section(title: &str) -> String {
    format!("\n/* ---- {title} {} */\n", "-".repeat(110_usize.saturating_sub(title.len())))
}

/// Writes the opening comment of both files.
pub fn banner(average: &AverageParts, origin: &Origin, hash: &str) -> String {
    let members = match average.members.as_slice() {
        [one] => network_line(&one.parts),
        all => {
            let line = |(k, member): (usize, &MemberParts)| {
                format!(" * member {}, weight {}:\n{}", k + 1, member.weight, network_line(&member.parts))
            };
            let lines: String = all.iter().enumerate().map(line).collect();
            format!(" * average  of {} estimators\n{lines}", all.len())
        }
    };
    format!(
        "{HEAD}{}. Do not edit: export it again.\n *\n{} * from     {}\n * SHA-256  {hash}\n{members} */\n",
        env!("CARGO_PKG_VERSION"),
        equations(average),
        plain(&origin.source),
    )
}

fn equations(average: &AverageParts) -> &'static str {
    let several = average.members.len() > 1;
    let learned = average.members.iter().any(|member| member.parts.has_network());
    match (several, learned) {
        (false, false) => " *   y_k = p_k, the nominal model with its effects\n *\n",
        (false, true) => {
            " *   y_k = p_k + r_k,   r_k = spread network(z_k, dt_k, h_(k-1)) + mean,   z = (x - mean)/spread\n *\n"
        }
        (true, false) => " *   y_k = sum_m w_m p_(m,k), nominal models with their effects\n *\n",
        (true, true) => {
            " *   y_k = sum_m w_m (p_(m,k) + r_(m,k)),   r_k = spread network(z_k, dt_k, h_(k-1)) + mean,   z = (x - mean)/spread\n *\n"
        }
    }
}

fn network_line(parts: &Parts) -> String {
    if !parts.has_network() {
        return " * network  none: the nominal model alone\n".into();
    }
    let state = match parts.state {
        StateRule::Running => "runs on since the last start or gap".into(),
        StateRule::Window(length) => format!("over windows of {length} samples"),
    };
    format!(" * network  {}, {} parameters; its state {state}\n", describe(&parts.network), parts.weights.len())
}

/// Returns the kind and sizes of a network.
pub fn describe(shape: &Shape) -> String {
    let body = match &shape.body {
        Body::Cfc(cfc) => {
            let mode = format!("{:?}", cfc.mode).to_lowercase();
            let (layers, width) = (cfc.backbone_layers, cfc.backbone_units);
            format!("CfC of {} units, mode {mode}, {layers} backbone layers of {width}", cfc.units)
        }
        Body::Gru(gru) => format!("GRU of {} layers of {} units", gru.layers, gru.units),
        Body::Mlp(mlp) => format!("MLP with hidden layers {:?}", mlp.hidden),
    };
    format!("{body}, {} inputs, {} outputs", shape.inputs, shape.outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_ends_a_comment() {
        assert_eq!(plain("q*/1 [m/s²] ü $name ??/"), "q* /1 [m/s^2] ? ?name ?/");
    }

    #[test]
    fn numbers_read_back() {
        for value in [1.0, -0.1, 1e-30, 1.5e20, f64::MIN_POSITIVE] {
            assert_eq!(double(value).parse(), Ok(value));
            assert!(double(value).contains(['.', 'e']), "{}", double(value));
        }
        assert_eq!(float(0.1), "0.1f");
        assert_eq!(float(1e-9), "1e-9f");
    }
}
