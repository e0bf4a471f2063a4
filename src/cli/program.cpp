#include "cli/program.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "cli/options.hpp"

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

namespace doppel {
namespace {

/// Throws if the word in the place of the command is no command.
void refuse_unknown_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    for (const auto* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), word) != names.end()) return;
    throw bad_input(
        "there is no command \"{}\"; {}", word,
        did_you_mean("", word, {names.begin(), names.end()}, fmt::format("there are {}", fmt::join(names, ", "))));
}

/// Throws if the word in the place of the command is an unknown option.
void refuse_unknown_option(const CLI::App& app, const std::string& word) {
    const auto name = word.substr(0, word.find('='));
    if (!app.get_option_no_throw(name))
        throw bad_input("there is no option \"{}\" before a command; there are --help and --version", name);
}

/// An empty argument is usually an unset variable of a script; treating it as missing could apply the command to
/// everything.
void refuse_empty_arguments(const std::vector<std::string>& words) {
    for (std::size_t i = 1; i < words.size(); ++i) {
        const auto& word = words[i];
        const bool of_option = words[i - 1].starts_with('-');
        if (word.empty())
            throw bad_input("{} is empty; leave it out, or give a value",
                            of_option ? words[i - 1] : fmt::format("argument {}", i));
        if (word.starts_with("--") && word.find('=') == word.size() - 1)
            throw bad_input("{} is empty; leave it out, or give a value", word.substr(0, word.size() - 1));
    }
}

/// If a standard stream were closed, the next opened file would take its place, and messages would go into it. The
/// substitute can neither be read nor written, so that uses are noticed.
void fill_standard_streams() {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream)
            throw io_failed("/dev/null cannot be opened in place of a closed standard stream");
}

/// Prints the message as one readable line; never throws.
int failed(ExitCode code, std::string_view message) {
    constexpr std::size_t maximum = 4000;  // bytes
    const auto line = shortened(on_one_line(message), maximum);
    std::fprintf(stderr, "doppel: %s\n", line.c_str());
    return static_cast<int>(code);
}

}  // namespace

int run_program(int argc, char** argv) {
    try {
        fill_standard_streams();
        std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit is an error to report, not a signal to die from
        const std::vector<std::string> words(argv, argv + argc);
        const bool completes =
            words.size() > 1 && words[1] == "complete";  // called by the scripts of "doppel completion"
        if (!completes) refuse_empty_arguments(words);

        CLI::App app("Doppel films pairs of chaotic pendulums that differ slightly, and charts how they diverge.",
                     "doppel");
        app.set_version_flag("--version", fmt::format("doppel {} ({})", version(), revision()));
        app.footer(
            "doppel COMMAND --help explains each command. Exit codes: 0 done, 1 compare found a difference,\n"
            "2 bad usage or input, 3 the method failed, 4 reading, writing or encoding failed, 75 the same,\n"
            "where trying again may help, 130 interrupted, 143 terminated.");
        app.require_subcommand(1);
        app.get_formatter()->column_width(26);

        int exit_code = 0;
        for (const auto add : {add_render, add_simulate, add_still, add_figure, add_fit}) add(app);
        add_compare(app, exit_code);
        for (const auto add : {add_list, add_show, add_check, add_certify, add_init, add_schema, add_completion})
            add(app);
        if (completes) {
            write_out(completions(app, {words.begin() + 2, words.end()}));
            return 0;
        }
        if (words.size() > 1)
            (words[1].starts_with('-') ? refuse_unknown_option : refuse_unknown_command)(app, words[1]);
        try {
            app.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            if (error.get_exit_code() == 0) {
                std::ostringstream help;
                app.exit(error, help);
                write_out(help.str());
                return 0;
            }
            const auto parsed = app.get_subcommands();
            const auto command = parsed.empty() ? "" : parsed.front()->get_name() + " ";
            return failed(ExitCode::bad_input, fmt::format("{}; see doppel {}--help", error.what(), command));
        }
        return exit_code;
    } catch (const Error& error) {
        const bool is_terminated = error.code() == ExitCode::interrupted && was_terminated();
        const int code = failed(is_terminated ? ExitCode::terminated : error.code(), error.what());
        for (const auto& line : error.further()) failed(error.code(), line);
        return code;
    } catch (const std::bad_alloc&) {
        return failed(ExitCode::io_failed, "there is not enough memory");
    } catch (const std::exception& error) {
        return failed(ExitCode::io_failed, error.what());
    }
}

}  // namespace doppel
