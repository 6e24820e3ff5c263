//! What a pure function gave, for whoever asks for the same again.

use quick_cache::Weighter;
use quick_cache::sync::Cache;
use std::fmt;
use std::hash::Hash;
use std::sync::Arc;

/// Results by what they follow from, within a bound; those asked for lately and often stay.
///
/// What is kept decides how long a run takes, never what comes out. Clones share what they keep, and so do threads: two that
/// ask for the same at the same time both work it out, and neither waits.
pub struct Memo<K, V>(Arc<Cache<K, Arc<V>, Sizes<K, V>>>);

/// How large a result and what it follows from are together, in bytes or so.
type Size<K, V> = fn(&K, &V) -> usize;

struct Sizes<K, V>(Size<K, V>);

impl<K: Eq + Hash, V> Memo<K, V> {
    /// Keeps `most` results.
    pub fn of(most: usize) -> Self {
        Self(Arc::new(Cache::with_weighter(most, most as u64, Sizes(|_, _| 1))))
    }

    /// Keeps results that are no larger than `most` bytes together, by `size`; about `many` of them.
    pub fn of_bytes(most: usize, many: usize, size: Size<K, V>) -> Self {
        Self(Arc::new(Cache::with_weighter(many, most as u64, Sizes(size))))
    }

    /// What follows from `key`: `make(&key)`, now or earlier.
    pub fn get(&self, key: K, make: impl FnOnce(&K) -> V) -> Arc<V> {
        if let Some(known) = self.0.get(&key) {
            return known;
        }
        let made = Arc::new(make(&key));
        self.0.insert(key, Arc::clone(&made));
        made
    }
}

impl<K, V> Weighter<K, Arc<V>> for Sizes<K, V> {
    fn weight(&self, key: &K, value: &Arc<V>) -> u64 {
        (self.0)(key, value) as u64
    }
}

impl<K, V> Clone for Sizes<K, V> {
    fn clone(&self) -> Self {
        Self(self.0)
    }
}

impl<K, V> Clone for Memo<K, V> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<K, V> fmt::Debug for Memo<K, V> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Memo")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn the_same_is_worked_out_once() {
        let memo = Memo::of(8);
        let made = Cell::new(0);
        let square = |number: u64| {
            *memo.get(number, |number| {
                made.set(made.get() + 1);
                number * number
            })
        };
        assert_eq!([square(3), square(4), square(3), square(3)], [9, 16, 9, 9]);
        assert_eq!(made.get(), 2);
    }

    #[test]
    fn no_more_is_kept_than_was_said() {
        let check = |memo: Memo<usize, Vec<u8>>, at_most: usize| {
            let made: Vec<Arc<Vec<u8>>> = (0..1000).map(|key| memo.get(key, |key| vec![0; *key])).collect();
            assert!(made.iter().enumerate().all(|(key, value)| value.len() == key), "whatever is kept");
            // Whoever is kept is held twice: here and there.
            let kept: usize = made.iter().filter(|one| Arc::strong_count(one) > 1).map(|one| one.len()).sum();
            assert!(0 < kept && kept <= at_most, "{kept} bytes");
        };
        check(Memo::of_bytes(20_000, 100, |_, value| value.len()), 20_000);
        check(Memo::of(8), 8 * 999);
    }
}
