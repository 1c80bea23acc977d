//! An arm and its tip in space along trials, for the script that draws and turns them, and for a file.
//!
//! | symbol  | meaning                                                          | shape     | unit        |
//! | `frame` | rows are the axes right, ahead and up of the drawing, in the data's | 3 × 3  | 1           |
//! | `arm`   | points from base to tip; none where the nominal model is no arm   | T × K × 3 | as displayed |
//! | `tips`  | who says where the tip is: the measurement, the nominal model, …  | T × 3     | as displayed |

use acm_train::run::nominal::poses::Place;
use serde::Serialize;

use super::numbers::digits;
use crate::tables::quoted;

/// Data of a figure in space.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Space {
    /// Unit of all lengths.
    pub unit: String,
    /// Names of the three axes.
    pub axes: Vec<String>,
    /// Directions right, ahead and up in the data's axes.
    pub frame: [[f64; 3]; 3],
    /// The arrow of the residual is drawn so many times as long.
    pub magnified: f64,
    /// The trials, one after the other.
    pub trials: Vec<SpaceTrial>,
}

/// One trial.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpaceTrial {
    /// Name of the trial.
    pub trial: String,
    /// Time stamps, s.
    pub time: Vec<f64>,
    /// The arm at each time, or nothing.
    pub arm: Vec<Vec<[f64; 3]>>,
    /// Tips: first the measurement, then the nominal model, then the learned models.
    pub tips: Vec<Tip>,
    /// Loads on the arm.
    pub loads: Vec<SpaceLoad>,
}

/// Measured or estimated positions of the tip.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tip {
    /// Name of the measurement or the estimator.
    pub name: String,
    /// Colour, `#rrggbb`.
    pub colour: String,
    /// Positions at each time.
    pub points: Vec<[f64; 3]>,
}

/// A load at each time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpaceLoad {
    /// Name of the load: `weight`, `payload` or `downwash`.
    pub name: String,
    /// Place of the load.
    pub place: Place,
    /// Unit vector in the data's axes.
    pub direction: [f64; 3],
    /// Unit of the sizes.
    pub unit: String,
    /// Size at each time; empty where only the direction is known.
    pub size: Vec<f64>,
}

impl Space {
    /// Returns whether there is an arm.
    pub fn has_arm(&self) -> bool {
        self.trials.iter().any(|trial| !trial.arm.is_empty())
    }

    /// Returns the longest edge of the box around everything.
    pub fn extent(&self) -> f64 {
        let all = || self.trials.iter().flat_map(SpaceTrial::points);
        let edge = |axis: usize| {
            let fold = |(low, high): (f64, f64), p: &[f64; 3]| (low.min(p[axis]), high.max(p[axis]));
            let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), fold);
            high - low
        };
        (0..3).map(edge).fold(0.0, f64::max)
    }

    /// Returns the data with numbers as long as a drawing needs them: tips with six significant digits, the arm to a
    /// 2000th of the [`Space::extent`].
    pub fn rounded(&self) -> Self {
        let step = 10f64.powf((self.extent() / 2000.0).log10().floor());
        let coarse = |value: f64| ((value / step).round() * step * 1e9).round() / 1e9;
        let trials = self.trials.iter().map(|trial| SpaceTrial {
            trial: trial.trial.clone(),
            time: trial.time.iter().map(|&time| digits(time)).collect(),
            arm: trial.arm.iter().map(|arm| arm.iter().map(|point| point.map(coarse)).collect()).collect(),
            tips: trial.tips.iter().map(Tip::rounded).collect(),
            loads: trial.loads.iter().map(SpaceLoad::rounded).collect(),
        });
        Self { trials: trials.collect(), ..self.clone() }
    }

    /// Writes every number: a line for each point, from base to tip, then for each tip.
    pub fn csv(&self) -> String {
        let label = |name: &String| quoted(&format!("{name} [{}]", self.unit));
        let axes: Vec<String> = self.axes.iter().map(label).collect();
        let mut lines = vec![format!("trial,time [s],what,point,{}", axes.join(","))];
        for trial in &self.trials {
            for (t, time) in trial.time.iter().enumerate() {
                let head = format!("{},{time}", quoted(&trial.trial));
                let arm = trial.arm.get(t).into_iter().flatten().enumerate();
                lines.extend(arm.map(|(k, [x, y, z])| format!("{head},nominal arm,{k},{x},{y},{z}")));
                for tip in &trial.tips {
                    let [x, y, z] = tip.points[t];
                    lines.push(format!("{head},{},,{x},{y},{z}", quoted(&tip.name)));
                }
            }
        }
        lines.join("\n") + "\n"
    }
}

impl SpaceTrial {
    /// Returns all points that are drawn.
    fn points(&self) -> impl Iterator<Item = &[f64; 3]> {
        self.arm.iter().flatten().chain(self.tips.iter().flat_map(|tip| &tip.points))
    }
}

impl Tip {
    fn rounded(&self) -> Self {
        Self { points: self.points.iter().map(|point| point.map(digits)).collect(), ..self.clone() }
    }
}

impl SpaceLoad {
    fn rounded(&self) -> Self {
        Self { size: self.size.iter().map(|&size| digits(size)).collect(), ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> Space {
        let tip = |name: &str, point| Tip { name: name.into(), colour: "#000000".into(), points: vec![point] };
        let trial = SpaceTrial {
            trial: "a, b".into(),
            time: vec![1.0 / 3.0],
            arm: vec![vec![[0.0; 3], [1.0 / 3.0, 0.0, -600.123_456_78]]],
            tips: vec![tip("measured", [1.0 / 3.0, 2.0, 3.0]), tip("Nominal", [4.0, 5.0, 6.0])],
            loads: vec![],
        };
        let frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let axes = ["x", "y", "z"].map(String::from).to_vec();
        Space { unit: "mm".into(), axes, frame, magnified: 1.0, trials: vec![trial] }
    }

    /// Oracle: by hand. The box is 606.1 mm high, so an arm is drawn to 0.1 mm.
    #[test]
    fn a_page_has_the_digits_that_a_drawing_needs() {
        let rounded = &space().rounded().trials[0];
        assert_eq!(rounded.arm[0][1], [0.3, 0.0, -600.1]);
        assert_eq!((rounded.tips[0].points[0][0], rounded.time[0]), (0.333_333, 0.333_333));
    }

    #[test]
    fn a_file_has_a_line_for_each_point_with_all_digits() {
        let csv = space().csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines[0], "trial,time [s],what,point,x [mm],y [mm],z [mm]");
        assert_eq!(lines[2], "\"a, b\",0.3333333333333333,nominal arm,1,0.3333333333333333,0,-600.12345678");
        assert_eq!(lines[4], "\"a, b\",0.3333333333333333,Nominal,,4,5,6");
        assert_eq!(lines.len(), 5);
    }
}
