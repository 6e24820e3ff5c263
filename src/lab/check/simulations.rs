use super::{Checker, Names, span};
use crate::lab::SimulationDefinition;
use crate::lab::defaults;
use crate::lab::file::{BlockFile, LabFile, SimulationFile, SourceFile, Spanned, Text};
use crate::nonlinear::{Block, Chain, Nonlinearity, Signal};

/// The simulations whose output jumps where a nonlinearity switches, with the block that makes it jump.
pub(super) fn jumping(file: &LabFile) -> Vec<(&str, &'static str)> {
    let jumps = |simulation: &SimulationFile| {
        simulation.chain.value.iter().fold(None, |jumps, block| match &block.value {
            BlockFile::Relay { .. } => Some("relay"),
            BlockFile::Quantizer { .. } => Some("quantizer"),
            BlockFile::CoulombFriction { .. } => Some("coulomb_friction"),
            BlockFile::RateLimit { .. } => None,
            BlockFile::TransferFunction { num, den } if degree(num) < degree(den) => None,
            _ => jumps,
        })
    };
    let simulations = file.simulations.0.iter();
    simulations.filter_map(|(id, simulation)| Some((id.value.as_str(), jumps(simulation)?))).collect()
}

/// How many coefficients there are behind leading zeros.
fn degree(coefficients: &Spanned<Vec<Text>>) -> usize {
    let zero = |text: &&Text| text.value.trim().parse::<f64>() == Ok(0.0);
    coefficients.value.iter().skip_while(zero).count()
}

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
        self.letters_in_amounts.clear();
        let source = self.source(&file.source.value);
        let blocks: Vec<_> = file.chain.value.iter().map(|block| self.block(block)).collect();
        let duration_s = self.positive_amount(&file.duration_s, "a duration");
        let letters = std::mem::take(&mut self.letters_in_amounts);
        self.one_of(&file.shown_in, "question", &names.questions);
        let blocks = blocks.into_iter().collect::<Option<Vec<_>>>()?;
        let nonlinearity = blocks.iter().find_map(|block| match block {
            Block::Nonlinearity(nonlinearity) => Some(*nonlinearity),
            Block::Linear { .. } => None,
        });
        if nonlinearity.is_none() {
            let message = format!("the chain of `{}` has no nonlinearity in it", id.value);
            let help = "add `saturation`, `dead_zone`, `backlash`, `relay`, `quantizer`, `rate_limit` or `coulomb_friction`".to_owned();
            self.error("lab.simulation", span(&file.chain), message, Some(help));
        }
        Some(SimulationDefinition {
            id: id.value.clone(),
            title: defaults::title(file.title.as_ref(), &id.value),
            chain: Chain { source: source?, blocks },
            duration_s: duration_s?,
            output: file.output.name.trim().to_owned(),
            output_unit: file.output.unit.clone(),
            input: file.input.name.trim().to_owned(),
            input_unit: file.input.unit.clone(),
            nonlinearity: nonlinearity?,
            shown_in: file.shown_in.value.clone(),
            letters,
        })
    }

    fn source(&mut self, file: &SourceFile) -> Option<Signal> {
        match file {
            SourceFile::Sine { amplitude, frequency_rad_s, phase_rad, bias } => {
                let amplitude = self.amount(amplitude);
                let frequency = self.positive_amount(frequency_rad_s, "a frequency");
                let phase = self.amount_or(phase_rad.as_ref(), 0.0);
                let bias = self.amount_or(bias.as_ref(), 0.0);
                Some(Signal::Sine {
                    amplitude: amplitude?,
                    frequency_rad_s: frequency?,
                    phase_rad: phase?,
                    bias: bias?,
                })
            }
            SourceFile::Pulse { low, high, period_s, duty, delay_s } => {
                let low = self.amount_or(low.as_ref(), 0.0);
                let high = self.amount(high);
                let period = self.positive_amount(period_s, "a period");
                let duty = match duty {
                    Some(text) => self.duty(text),
                    None => Some(0.5),
                };
                let delay = self.amount_or(delay_s.as_ref(), 0.0);
                Some(Signal::Pulse {
                    low: low?,
                    high: high?,
                    period_s: period?,
                    duty: duty?,
                    delay_s: delay?,
                })
            }
            SourceFile::Step { amplitude, time_s } => {
                let amplitude = self.amount(amplitude);
                let time = self.amount_or(time_s.as_ref(), 0.0);
                Some(Signal::Step { amplitude: amplitude?, time_s: time? })
            }
        }
    }

    fn block(&mut self, file: &Spanned<BlockFile>) -> Option<Block> {
        match &file.value {
            BlockFile::Saturation { limit } => self
                .positive_amount(limit, "the limit of a saturation")
                .map(|limit| Block::Nonlinearity(Nonlinearity::Saturation { limit })),
            BlockFile::DeadZone { threshold } => self
                .positive_amount(threshold, "the threshold of a dead zone")
                .map(|threshold| Block::Nonlinearity(Nonlinearity::DeadZone { threshold })),
            BlockFile::Backlash { width } => self
                .positive_amount(width, "the width of a backlash")
                .map(|width| Block::Nonlinearity(Nonlinearity::Backlash { width })),
            BlockFile::Relay { amplitude, hysteresis, dead_zone } => {
                let amplitude = self.positive_amount(amplitude, "the amplitude of a relay");
                let hysteresis_is = self.not_negative(hysteresis.as_ref(), "the hysteresis of a relay");
                let dead_zone_is = self.not_negative(dead_zone.as_ref(), "the dead zone of a relay");
                let (hysteresis_is, dead_zone_is) = (hysteresis_is?, dead_zone_is?);
                if dead_zone_is > 0.0
                    && hysteresis_is >= dead_zone_is
                    && let Some(text) = hysteresis
                {
                    let message = format!(
                        "the hysteresis of a relay must be below its dead zone, not {} beside {dead_zone_is}",
                        text.value
                    );
                    let help = "both are half-widths: it switches on at dead_zone + hysteresis, off at dead_zone - hysteresis";
                    self.error("lab.simulation", span(text), message, Some(help.to_owned()));
                    return None;
                }
                Some(Block::Nonlinearity(Nonlinearity::Relay {
                    amplitude: amplitude?,
                    hysteresis: hysteresis_is,
                    dead_zone: dead_zone_is,
                }))
            }
            BlockFile::Quantizer { interval } => self
                .positive_amount(interval, "the interval of a quantizer")
                .map(|interval| Block::Nonlinearity(Nonlinearity::Quantizer { interval })),
            BlockFile::RateLimit { rising, falling } => {
                let (rising, falling_is) =
                    (self.positive_amount(rising, "the rising rate of a rate limit"), self.amount(falling));
                let falling_is = falling_is?;
                if falling_is >= 0.0 {
                    let message =
                        format!("the falling rate of a rate limit must be below 0, not {}", falling.value);
                    let help = (falling_is > 0.0).then(|| format!("did you mean `-{falling_is}`?"));
                    self.error("lab.number", span(falling), message, help);
                    return None;
                }
                Some(Block::Nonlinearity(Nonlinearity::RateLimit { rising: rising?, falling: falling_is }))
            }
            BlockFile::CoulombFriction { coulomb, viscous } => {
                let coulomb = self.positive_amount(coulomb, "the Coulomb friction");
                let viscous = self.not_negative(viscous.as_ref(), "the viscous friction");
                Some(Block::Nonlinearity(Nonlinearity::CoulombFriction {
                    coulomb: coulomb?,
                    viscous: viscous?,
                }))
            }
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

    /// A number of 0 or more, 0 when it is left out; `what` names it.
    fn not_negative(&mut self, text: Option<&Text>, what: &str) -> Option<f64> {
        let value = self.amount_or(text, 0.0)?;
        if value >= 0.0 {
            return Some(value);
        }
        let text = text?;
        self.error(
            "lab.number",
            span(text),
            format!("{what} cannot be below 0, but is {}", text.value),
            None,
        );
        None
    }

    /// Highest power first, leading zeros dropped.
    fn coefficients(&mut self, file: &Spanned<Vec<Text>>) -> Option<Vec<f64>> {
        let values: Vec<_> = file.value.iter().map(|text| self.amount(text)).collect();
        let values = values.into_iter().collect::<Option<Vec<_>>>()?;
        Some(values.into_iter().skip_while(|value| *value == 0.0).collect())
    }
}
