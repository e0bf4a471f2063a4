#pragma once

namespace CLI {
class App;
}

namespace doppel {

/// The program from its arguments to its exit code: here, and nowhere else, errors are caught and said.
int run_program(int argc, char** argv);

// Each adds a command to the program: its options, its help, and what it does.
void add_render(CLI::App& app);
void add_simulate(CLI::App& app);
void add_still(CLI::App& app);
void add_figure(CLI::App& app);
void add_fit(CLI::App& app);
void add_compare(CLI::App& app, int& exit_code);  // the code is 1 where the pictures differ
void add_list(CLI::App& app);
void add_show(CLI::App& app);
void add_check(CLI::App& app);
void add_schema(CLI::App& app);
void add_init(CLI::App& app);
void add_completion(CLI::App& app);

}  // namespace doppel
