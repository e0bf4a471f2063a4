#include "output/files.hpp"

#include "base/error.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

namespace doppel {

namespace fs = std::filesystem;

Stream open_stream(const fs::path& path, int flags, const char* mode) {
    const int file = open(path.c_str(), flags | O_CLOEXEC, 0666);
    Stream stream(file < 0 ? nullptr : fdopen(file, mode));
    if (file >= 0 && !stream) close(file);
    return stream;
}

Stream create_file(const fs::path& path) {
    auto stream = open_stream(path, O_RDWR | O_CREAT | O_TRUNC | O_NOFOLLOW, "w+b");
    if (!stream) throw cannot(path, "written");
    return stream;
}

Stream open_file(const fs::path& path) {
    auto stream = open_stream(path, O_RDONLY | O_NONBLOCK, "rb");  // opening a pipe without a writer would block
    struct stat status {};
    if (!stream || fstat(fileno(stream.get()), &status) != 0) throw cannot(path, "read");
    if (!S_ISREG(status.st_mode)) throw io_failed("{} is not a regular file", path.string());
    return stream;
}

std::string start_of_file(const fs::path& path, std::size_t maximum) {
    try {
        const Stream file = open_file(path);
        std::string bytes(maximum, '\0');
        bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
        return bytes;
    } catch (const Error&) {
        return {};
    }
}

fs::file_type type_of(const fs::path& path) {
    std::error_code ignored;
    return fs::symlink_status(path, ignored).type();
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::error_code error;
    std::vector<std::string> names;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        names.push_back(entry->path().filename().string());
    if (error) throw cannot(folder, "read", error.value());
    std::ranges::sort(names);
    return names;
}

void rename_file(const fs::path& from, const fs::path& to) {
    if (rename(from.c_str(), to.c_str()) != 0) throw cannot(from, "renamed to " + to.string());
}

void OutputFile::write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) throw cannot(path_, "written");
}

void OutputFile::flush() {
    if (std::fflush(file_.get()) != 0) throw cannot(path_, "written");
}

void OutputFile::close() {
    // flushes the last bytes
    if (std::fclose(file_.release()) != 0) throw cannot(path_, "written");
}

void write_file(const fs::path& path, std::string_view text) {
    OutputFile file(path);
    file.write(text);
    file.close();
}

TemporaryFolder::TemporaryFolder() {
    const char* const given = std::getenv("TMPDIR");
    const fs::path parent = given && *given ? given : "/tmp";
    auto place = (parent / "doppel-XXXXXX").string();
    if (!mkdtemp(place.data())) throw cannot(parent, "used for temporary files (TMPDIR)");
    path_ = place;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

Error cannot(const fs::path& path, std::string_view what, int reason) {
    return {code_of_errno(reason),
            fmt::format("{}: cannot be {}: {}", path.string(), what, std::generic_category().message(reason))};
}

}  // namespace doppel
