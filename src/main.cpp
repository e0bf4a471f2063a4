#include "cli/program.hpp"

int main(int argc, char** argv) {
    return doppel::run_program(argc, argv);
}
