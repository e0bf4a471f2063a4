#pragma once

namespace doppel {

/// Runs the program and returns its exit code. Errors are caught and printed only here.
int run_program(int argc, char** argv);

}  // namespace doppel
