#pragma once

namespace CLI {
class App;
}

namespace doppel {

/// Runs the program and returns its exit code. Errors are caught and printed only here.
int run_program(int argc, char** argv);

// Each adds a command: its options, its help, and its action.
void add_render(CLI::App& app);
void add_simulate(CLI::App& app);
void add_still(CLI::App& app);
void add_figure(CLI::App& app);
void add_fit(CLI::App& app);
void add_compare(CLI::App& app, int& exit_code);  // sets the exit code 1 if pictures differ
void add_list(CLI::App& app);
void add_show(CLI::App& app);
void add_check(CLI::App& app);
void add_certify(CLI::App& app);
void add_schema(CLI::App& app);
void add_init(CLI::App& app);
void add_completion(CLI::App& app);

}  // namespace doppel
