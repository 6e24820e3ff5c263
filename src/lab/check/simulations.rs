use super::{Checker, Names, span};
use crate::lab::SimulationDefinition;
use crate::lab::file::{BlockFile, LabFile, SimulationFile, SourceFile, Text};
use crate::nonlinear::{Block, Chain, Nonlinearity, Signal};
use serde_yaml::Spanned;

impl Checker<'_> {
    pub(super) fn simulations(
        &mut self,
        file: &LabFile,
        names: &Names<'_>,
    ) -> Option<Vec<SimulationDefinition>> {
        let simulations = file.simulations.0.iter().map(|(id, s)| {
            self.id(id, "simulation id");
            if file.models.0.iter().any(|(model, _)| model.value == id.value) {
                let message = format!("the simulation `{}` has the name of a model", id.value);
                self.error("lab.duplicate", span(id), message, Some("choose another id".to_owned()));
            }
            self.simulation(id, s, names)
        });
        let simulations: Vec<_> = simulations.collect();
        simulations.into_iter().collect()
    }

    fn simulation(
        &mut self,
        id: &Text,
        file: &SimulationFile,
        names: &Names<'_>,
    ) -> Option<SimulationDefinition> {
        let source = self.source(&file.source.value);
        let blocks: Vec<_> = file.chain.value.iter().map(|block| self.block(block)).collect();
        let duration_s = self.positive(&file.duration_s, "a duration");
        self.one_of(&file.shown_in, "question", &names.questions);
        let blocks = blocks.into_iter().collect::<Option<Vec<_>>>()?;
        let nonlinearity = blocks.iter().find_map(|block| match block {
            Block::Nonlinearity(nonlinearity) => Some(*nonlinearity),
            Block::Linear { .. } => None,
        });
        if nonlinearity.is_none() {
            let message = format!("the chain of `{}` has no nonlinearity in it", id.value);
            let help = "add `saturation`, `dead_zone` or `backlash`".to_owned();
            self.error("lab.simulation", span(&file.chain), message, Some(help));
        }
        Some(SimulationDefinition {
            id: id.value.clone(),
            title: file.title.trim().to_owned(),
            chain: Chain { source: source?, blocks },
            duration_s: duration_s?,
            output: file.output.name.trim().to_owned(),
            output_unit: file.output.unit.clone(),
            input: file.input.name.trim().to_owned(),
            input_unit: file.input.unit.clone(),
            nonlinearity: nonlinearity?,
            shown_in: file.shown_in.value.clone(),
        })
    }

    fn source(&mut self, file: &SourceFile) -> Option<Signal> {
        match file {
            SourceFile::Sine { amplitude, frequency_rad_s, phase_rad, bias } => {
                let amplitude = self.float(amplitude);
                let frequency = self.positive(frequency_rad_s, "a frequency");
                let phase = self.float_or(phase_rad.as_ref(), 0.0);
                let bias = self.float_or(bias.as_ref(), 0.0);
                Some(Signal::Sine {
                    amplitude: amplitude?,
                    frequency_rad_s: frequency?,
                    phase_rad: phase?,
                    bias: bias?,
                })
            }
            SourceFile::Pulse { low, high, period_s, duty, delay_s } => {
                let low = self.float_or(low.as_ref(), 0.0);
                let high = self.float(high);
                let period = self.positive(period_s, "a period");
                let duty = match duty {
                    Some(text) => self.fraction(text, "a duty").map(|duty| crate::algebra::to_f64(&duty)),
                    None => Some(0.5),
                };
                let delay = self.float_or(delay_s.as_ref(), 0.0);
                Some(Signal::Pulse {
                    low: low?,
                    high: high?,
                    period_s: period?,
                    duty: duty?,
                    delay_s: delay?,
                })
            }
            SourceFile::Step { amplitude, time_s } => {
                let amplitude = self.float(amplitude);
                let time = self.float_or(time_s.as_ref(), 0.0);
                Some(Signal::Step { amplitude: amplitude?, time_s: time? })
            }
        }
    }

    fn block(&mut self, file: &Spanned<BlockFile>) -> Option<Block> {
        match &file.value {
            BlockFile::Saturation { limit } => self
                .positive(limit, "the limit of a saturation")
                .map(|limit| Block::Nonlinearity(Nonlinearity::Saturation { limit })),
            BlockFile::DeadZone { threshold } => self
                .positive(threshold, "the threshold of a dead zone")
                .map(|threshold| Block::Nonlinearity(Nonlinearity::DeadZone { threshold })),
            BlockFile::Backlash { width } => self
                .positive(width, "the width of a backlash")
                .map(|width| Block::Nonlinearity(Nonlinearity::Backlash { width })),
            BlockFile::TransferFunction { num, den } => {
                let (n, d) = (self.coefficients(num), self.coefficients(den));
                let (n, d) = (n?, d?);
                if d.is_empty() {
                    self.error("lab.simulation", span(den), "a denominator cannot be zero", None);
                    return None;
                }
                if n.len() > d.len() {
                    let message = format!(
                        "the transfer function is improper: its numerator (degree {}) outranks its denominator (degree {})",
                        n.len() - 1,
                        d.len() - 1
                    );
                    self.error("lab.simulation", span(num), message, None);
                    return None;
                }
                Some(Block::Linear { num: n, den: d })
            }
        }
    }

    /// Highest power first, leading zeros dropped.
    fn coefficients(&mut self, file: &Spanned<Vec<Text>>) -> Option<Vec<f64>> {
        let values: Vec<_> = file.value.iter().map(|text| self.float(text)).collect();
        let values = values.into_iter().collect::<Option<Vec<_>>>()?;
        Some(values.into_iter().skip_while(|value| *value == 0.0).collect())
    }
}
