#pragma once

namespace doppel {

/// The program from its arguments to its exit code: here, and nowhere else, errors are caught and said.
int run_program(int argc, char** argv);

}  // namespace doppel
