//! Effects of the speed, the acceleration or the smoothed value of a signal on the outputs. All come from a parabola through half a window
//! that ends at the newest sample, as in acm-stream.

use super::pieces::{array, carrier};
use super::rings::Ring;
use super::{Asked, Body};

/// Writes an effect that adds a share of the rate `d[0]` and the acceleration `d[1]` in proportion to the size of each output.
pub fn motion(
    asked: &Asked,
    equation: &'static str,
    shapes: usize,
    share: &str,
    need: Option<&'static str>,
) -> Option<Body> {
    windowed(asked, equation, shapes, share, need.into_iter().collect(), "")
}

/// Writes an effect with a state of a kind that follows the smoothed signal `d[2]`, in proportion to the size of each output.
pub fn following(
    asked: &Asked,
    equation: &'static str,
    shapes: usize,
    share: &str,
    need: &'static str,
    kind: &str,
) -> Option<Body> {
    windowed(asked, equation, shapes, share, vec![need], &array(kind, 1))
}

fn windowed(
    asked: &Asked,
    equation: &'static str,
    shapes: usize,
    share: &str,
    mut needs: Vec<&'static str>,
    state: &str,
) -> Option<Body> {
    let (number, n, window) = (asked.number, asked.columns, asked.columns + shapes);
    let ring = Ring::of_window(0.5 * asked.theta[window].max(0.0));
    let memory = format!(
        "    int first, count;\n    double time[$NAME_EFFECT_{number}_ROOM];\n    double x[$NAME_EFFECT_{number}_ROOM];\n{state}"
    );
    let places = [
        ("@SHARE", share.to_owned()),
        ("@SIGNAL", carrier(asked)?.to_string()),
        ("@WINDOW", window.to_string()),
        ("@K", number.to_string()),
        ("@N", n.to_string()),
    ];
    let code = places.iter().fold(MOTION.to_owned(), |code, (key, value)| code.replace(key, value));
    needs.insert(0, "derivative");
    Some(Body { equation, memory, code, needs, macros: ring.macros(asked), ring: Some(ring) })
}

const MOTION: &str = "\
    const int newest = effect_@K_at(m, m->count);
    double d[3], share;
    m->time[newest] = time;
    m->x[newest] = in[@SIGNAL];
    m->count += 1;
    derivative(m->time, m->x, m->first, m->count, $NAME_EFFECT_@K_ROOM, 0.5 * v[@WINDOW], d);
    share = @SHARE;
    for (int j = 0; j < @N; ++j) {
        x[j] += v[j] * share;
    }
";
