#include "output/output_file.hpp"

#include "numeric/error.hpp"

#include <cerrno>
#include <system_error>

namespace doppel {
namespace {

Error cannot_write(const std::filesystem::path& path) {
    return io_failed("{}: cannot be written: {}", path.string(), std::generic_category().message(errno));
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
    if (!file_) throw cannot_write(path_);
}

void OutputFile::write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) throw cannot_write(path_);
}

void OutputFile::flush() {
    if (std::fflush(file_.get()) != 0) throw cannot_write(path_);
}

void OutputFile::close() {
    // the last bytes leave the buffer only here
    if (std::fclose(file_.release()) != 0) throw cannot_write(path_);
}

}  // namespace doppel
