//! Ring buffers of the samples of a time span, and the check of their capacity.

use super::Asked;
use crate::c99::text::double;

/// Samples per second that a ring has room for, at least.
const FASTEST: f64 = 1000.0;

/// A ring of an effect.
#[derive(Debug, Clone, Copy)]
pub struct Ring {
    /// Time span, s.
    longest: f64,
    /// Samples that it keeps however old they are.
    least: usize,
    /// Whether the memory has an index `near` that moves with the oldest sample.
    has_near: bool,
}

impl Ring {
    /// Returns the ring buffer of a delay, which searches its position from the last one.
    pub fn of_delay(longest: f64) -> Self {
        Self { longest, least: 1, has_near: true }
    }

    /// Returns the ring buffer of a window that ends at the newest sample; it holds at least the last nine samples.
    pub fn of_window(longest: f64) -> Self {
        Self { longest, least: 8, has_near: false }
    }

    /// Returns the definition of its room.
    pub fn macros(&self, asked: &Asked) -> String {
        let (number, longest) = (asked.number, self.longest);
        let rate = FASTEST.max(4.0 / asked.rig.step.max(1e-6));
        let room = self.least + 7 + (rate * longest.min(60.0)).ceil() as usize;
        format!(
            "\n/* Samples that effect {number} has room for: those of {longest} s. A sample that finds no room is refused \
             ($WHOLE_ROOM). */\n#ifndef $NAME_EFFECT_{number}_ROOM\n#define $NAME_EFFECT_{number}_ROOM {room}\n#endif\n"
        )
    }

    /// Writes the functions of the ring: the index of a sample, and whether there is room for the next.
    pub fn functions(&self, number: usize) -> String {
        let near = if self.has_near { "        m->near = m->near > 0 ? m->near - 1 : 0;\n" } else { "" };
        let text = FUNCTIONS.replace("@NEAR", near).replace("@LEAST", &self.least.to_string());
        text.replace("@K", &number.to_string())
    }

    /// Writes the lines that check for room before any effect takes the sample.
    pub fn check(&self, number: usize) -> String {
        format!(
            "    if (!effect_{number}_has_room(time, &memory->effect_{number}, {})) {{\n        return $WHOLE_ROOM;\n    }}\n",
            double(self.longest)
        )
    }
}

const FUNCTIONS: &str = "
/* Place of the k-th oldest sample. */
static int effect_@K_at(const $name_effect_@K *m, int k)
{
    const int place = m->first + k;
    return place < $NAME_EFFECT_@K_ROOM ? place : place - $NAME_EFFECT_@K_ROOM;
}

/* Lets go of what lies more than `longest` seconds back; whether there is room for one more sample then. */
static int effect_@K_has_room(double time, $name_effect_@K *m, double longest)
{
    while (m->count > @LEAST && m->time[effect_@K_at(m, 1)] <= time - longest) {
        m->first = effect_@K_at(m, 1);
        m->count -= 1;
@NEAR    }
    return m->count < $NAME_EFFECT_@K_ROOM;
}
";
