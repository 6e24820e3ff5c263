use super::setting::{Changed, Ports, Setting, exchanged};
use super::slopes::Variant;
use super::{Estimates, Pair};
use crate::model::mistakes::RealFunction;
use crate::model::mistakes::edit::Edit;

/// The mistakes by what they change.
struct Sorted {
    /// A part of an equation.
    nodes: Vec<usize>,
    /// Parameters, or the operating point.
    settings: Vec<usize>,
    /// Input or output.
    ports: Vec<usize>,
    /// The function that is there.
    wholes: Vec<usize>,
}

/// Takes what comes out.
type Give<'a> = dyn FnMut(usize, usize, Option<RealFunction>) + 'a;

impl Estimates {
    /// Visits what each two mistakes lead to that can be made at once, with each choice of parameter values.
    ///
    /// Nothing for a model of more than eight coordinates.
    pub fn pairs(&self, visit: &mut dyn FnMut(Pair, RealFunction)) {
        if !self.usable {
            return;
        }
        let sorted = self.sorted();
        let symbols = self.symbols();
        let node_pairs: Vec<(usize, usize, Vec<Variant>)> = self
            .fitting(&sorted.nodes, &sorted.nodes)
            .into_iter()
            .map(|(a, b)| (a, b, self.shared_variants(a, b, &symbols)))
            .collect();
        let setting_pairs = self.fitting(&sorted.settings, &sorted.settings);
        for choice in 0..self.choices.len() {
            let mut give = |a: usize, b: usize, function: Option<RealFunction>| {
                if let Some(function) = function.filter(|function| !function.num.is_zero()) {
                    visit(Pair { first: a.min(b), second: a.max(b), choice }, function);
                }
            };
            self.within_one_setting(choice, &sorted, &node_pairs, &mut give);
            for setting in &sorted.settings {
                self.with_a_setting(choice, *setting, &sorted, &mut give);
            }
            for (a, b) in &setting_pairs {
                let setting = self.setting(choice, &[*a, *b]);
                give(*a, *b, self.function(&setting, &[], self.ports(&[])));
            }
        }
    }

    fn sorted(&self) -> Sorted {
        let mut sorted =
            Sorted { nodes: Vec::new(), settings: Vec::new(), ports: Vec::new(), wholes: Vec::new() };
        for (place, mistake) in self.mistakes.iter().enumerate() {
            match mistake.edit {
                Edit::Nodes(..) => sorted.nodes.push(place),
                Edit::Parameter(_) | Edit::Point(_) | Edit::Rest(..) => sorted.settings.push(place),
                Edit::Output(_) | Edit::Input(_) => sorted.ports.push(place),
                Edit::Whole(_) => sorted.wholes.push(place),
            }
        }
        sorted
    }

    /// Each one of the first with each one of the second, where both can be made; of equal lists each two once.
    fn fitting(&self, first: &[usize], second: &[usize]) -> Vec<(usize, usize)> {
        let same = first == second;
        let all = first.iter().flat_map(|a| second.iter().map(move |b| (*a, *b)));
        all.filter(|(a, b)| !same || a < b)
            .filter(|(a, b)| self.mistakes[*a].combines_with(&self.mistakes[*b]))
            .collect()
    }

    fn within_one_setting(
        &self,
        choice: usize,
        sorted: &Sorted,
        node_pairs: &[(usize, usize, Vec<Variant>)],
        give: &mut Give<'_>,
    ) {
        let setting = self.setting(choice, &[]);
        let own = self.ports(&[]);
        let changed: Vec<Changed> =
            self.variants.iter().map(|variants| self.changed(&setting, variants)).collect();
        for (a, b, shared) in node_pairs {
            let both = self.changed(&setting, shared);
            let changes = exchanged(&[&changed[*a], &changed[*b], &both]);
            give(*a, *b, self.function(&setting, &changes, own));
        }
        let mut base = self.with_each(&setting, &changed, &sorted.nodes, own);
        base.extend(self.with_ports(&setting, &sorted.ports));
        for (place, function) in base {
            for (_, whole) in self.fitting(&[place], &sorted.wholes) {
                give(place, whole, function.and_then(|function| self.done(function, &[whole])));
            }
        }
        for (node, port) in self.fitting(&sorted.nodes, &sorted.ports) {
            let changes = exchanged(&[&changed[node]]);
            give(node, port, self.function(&setting, &changes, self.ports(&[port])));
        }
        for (a, b) in self.fitting(&sorted.ports, &sorted.ports) {
            give(a, b, self.function(&setting, &[], self.ports(&[a, b])));
        }
        let right = self.function(&setting, &[], own);
        for (a, b) in self.fitting(&sorted.wholes, &sorted.wholes) {
            give(a, b, right.and_then(|function| self.done(function, &[a, b])));
        }
    }

    /// `around`, and one more that changes no parameter and no point.
    fn with_a_setting(&self, choice: usize, around: usize, sorted: &Sorted, give: &mut Give<'_>) {
        let setting = self.setting(choice, &[around]);
        let own = self.ports(&[]);
        for (_, node) in self.fitting(&[around], &sorted.nodes) {
            let changed = self.changed(&setting, &self.variants[node]);
            give(around, node, self.function(&setting, &exchanged(&[&changed]), own));
        }
        for (_, port) in self.fitting(&[around], &sorted.ports) {
            give(around, port, self.function(&setting, &[], self.ports(&[port])));
        }
        let base = self.function(&setting, &[], own);
        for (_, whole) in self.fitting(&[around], &sorted.wholes) {
            give(around, whole, base.and_then(|function| self.done(function, &[whole])));
        }
    }

    fn with_each(
        &self,
        setting: &Setting,
        changed: &[Changed],
        nodes: &[usize],
        ports: Ports,
    ) -> Vec<(usize, Option<RealFunction>)> {
        let one = |node: &usize| (*node, self.function(setting, &exchanged(&[&changed[*node]]), ports));
        nodes.iter().map(one).collect()
    }

    fn with_ports(&self, setting: &Setting, ports: &[usize]) -> Vec<(usize, Option<RealFunction>)> {
        ports.iter().map(|port| (*port, self.function(setting, &[], self.ports(&[*port])))).collect()
    }
}
