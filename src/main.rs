fn main() -> std::process::ExitCode {
    polemark::cli::main()
}
