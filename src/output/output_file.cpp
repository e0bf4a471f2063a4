#include "output/output_file.hpp"

#include "base/error.hpp"

namespace doppel {

OutputFile::OutputFile(const FilePlace& place) : path_(place.path) {
    Descriptor file = create_file(place);
    file_.reset(fdopen(file.number(), "wb"));
    if (!file_) throw cannot(path_, "written");
    file.release();  // closed with the stream
}

void OutputFile::write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) throw cannot(path_, "written");
}

void OutputFile::flush() {
    if (std::fflush(file_.get()) != 0) throw cannot(path_, "written");
}

void OutputFile::close() {
    // the last bytes leave the buffer only here
    if (std::fclose(file_.release()) != 0) throw cannot(path_, "written");
}

}  // namespace doppel
