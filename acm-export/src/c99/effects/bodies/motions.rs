//! Effects of the speed or the acceleration of a signal on the outputs. Both come from a parabola through a window that
//! ends at the newest sample, as in acm-stream.

use super::pieces::carrier;
use super::rings::Ring;
use super::{Asked, Body};

/// Writes an effect that adds a share of the derivatives `d` in proportion to the size of each output.
pub fn motion(
    asked: &Asked,
    equation: &'static str,
    shapes: usize,
    share: &str,
    need: Option<&'static str>,
) -> Option<Body> {
    let (number, n, window) = (asked.number, asked.columns, asked.columns + shapes);
    let ring = Ring::of_window(asked.theta[window].max(0.0));
    let memory = format!(
        "    int first, count;\n    double time[$NAME_EFFECT_{number}_ROOM];\n    double x[$NAME_EFFECT_{number}_ROOM];\n"
    );
    let places = [
        ("@SHARE", share.to_owned()),
        ("@SIGNAL", carrier(asked)?.to_string()),
        ("@WINDOW", window.to_string()),
        ("@K", number.to_string()),
        ("@N", n.to_string()),
    ];
    let code = places.iter().fold(MOTION.to_owned(), |code, (key, value)| code.replace(key, value));
    let needs = std::iter::once("derivative").chain(need).collect();
    Some(Body { equation, memory, code, needs, macros: ring.macros(asked), ring: Some(ring) })
}

const MOTION: &str = "\
    const int newest = effect_@K_at(m, m->count);
    double d[2], share;
    m->time[newest] = time;
    m->x[newest] = in[@SIGNAL];
    m->count += 1;
    derivative(m->time, m->x, m->first, m->count, $NAME_EFFECT_@K_ROOM, v[@WINDOW], d);
    share = @SHARE;
    for (int j = 0; j < @N; ++j) {
        x[j] += v[j] * share;
    }
";
