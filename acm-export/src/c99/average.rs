//! The weighted mean of several estimators: the function `take` above those of the members.

use acm_stream::{AverageParts, MemberParts};

use super::member::is_single;
use super::text::{doubles, integers, section};

const AVERAGE: &str = include_str!("runtime/average.c");
const MEMBER: &str = include_str!("runtime/average_member.c");

/// Writes weights, places of inputs and the function `take`; nothing for a single estimator.
pub fn write(average: &AverageParts) -> String {
    if is_single(average).is_some() {
        return String::new();
    }
    let weights: Vec<f64> = average.members.iter().map(|member| member.weight).collect();
    let places = |(k, member): (usize, &MemberParts)| integers(&format!("PLACE_{}", k + 1), &member.places);
    section("Average")
        + "\n/* Weight of each member, and the inputs that it reads. */\n"
        + &doubles("WEIGHT", &weights)
        + &average.members.iter().enumerate().map(places).collect::<String>()
        + &AVERAGE.replace("@MEMBERS", &average.members.iter().enumerate().map(member).collect::<String>())
}

/// Returns the lines of one member. Where a later member refuses a sample that earlier ones took, all begin anew.
fn member((k, member): (usize, &MemberParts)) -> String {
    let number = (k + 1).to_string();
    let history = match k {
        0 => "        s->history = s->member1.history;\n".to_owned(),
        _ => format!(
            "        s->history = s->member{number}.history < s->history ? s->member{number}.history : s->history;\n"
        ),
    };
    let places = [
        ("@WIDTH", member.places.len().to_string()),
        ("@K", number),
        ("@M", k.to_string()),
        ("@RESTART", if k == 0 { String::new() } else { "            $whole_restart(s);\n".into() }),
        ("@HISTORY", history),
    ];
    places.iter().fold(MEMBER.to_owned(), |text, (key, value)| text.replace(key, value))
}
