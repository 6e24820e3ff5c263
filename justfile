# What CI runs.
check:
    .ci/run

# polemark turned on its own lab and its own sample class.
labs:
    cargo run --release -- verify
    cargo run --release -- grade submissions --out out

# Timings, as ratios within one run.
bench:
    cargo bench
