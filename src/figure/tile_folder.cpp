#include "figure/tile_folder.hpp"

#include "figure/tiles.hpp"
#include "output/png.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace doppel {
namespace {

constexpr const char* mark_name = "pyramid.json";

/// The first `most` bytes of a regular file.
std::string start_of(const FilePlace& place, std::size_t most) {
    const auto file = stream_of(open_file(place), "rb", place.path, "read");
    std::string text(most, '\0');
    text.resize(std::fread(text.data(), 1, most, file.get()));
    return text;
}

void write_mark(const FilePlace& place, const std::string& text) {
    OutputFile file(place);
    file.write(text);
    file.close();
}

Folder claimed(const Folder& above, const std::string& name, const Json& owner) {
    if (above.entry(name).kind == Entry::Kind::none) above.make_folder(name);
    auto folder = above.folder(name);
    const auto text = owner.dump(2) + "\n";
    const FilePlace place(folder, mark_name);
    // another process, with another shard, may be writing it
    std::string found;
    for (int tries = 0; tries < 6 && text.starts_with(found); ++tries) {
        if (folder.entry(mark_name).kind == Entry::Kind::none) {
            if (!folder.names().empty())
                throw io_failed("{} is not a folder of tiles of Doppel's; remove it, or give another folder with --out",
                                folder.path().string());
            write_mark(place, text);
        }
        found = start_of(place, text.size() + 1);
        if (found == text) return folder;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const auto part = part_of(place);
    const auto is_made_here = [&](const auto& entry) { return entry == mark_name || entry == part.name; };
    if (!text.starts_with(found) || !std::ranges::all_of(folder.names(), is_made_here))
        throw io_failed("{} belongs to another preset or version; remove it, or give another folder with --out",
                        folder.path().string());
    // of a run that was killed before it had written it all
    folder.remove(part.name);
    write_mark(part, text);
    rename_file(part, place);
    return folder;
}

/// Throws Error (exit 4) where it is no PNG of a tile's size.
void demand_tile(const FilePlace& place, Size size) {
    if (size != Size{Pyramid::tile, Pyramid::tile})
        throw io_failed("{}: has {}x{} px, a tile has {}x{}; remove it", place.path.string(), size.width, size.height,
                        Pyramid::tile, Pyramid::tile);
}

bool is_tile_name(std::string_view name) {
    return name.ends_with(".png") && name.find_first_not_of("0123456789-") == name.size() - 4;
}

}  // namespace

TileFolder::TileFolder(const Folder& above, const std::string& name, const Json& owner)
    : folder_(claimed(above, name, owner)) {
    for (const auto& tile : folder_.names()) {
        if (!is_tile_name(tile)) continue;
        const FilePlace place(folder_, tile);
        demand_tile(place, png_size(place));
        there_.insert(tile);
    }
}

std::size_t TileFolder::count() const {
    const std::lock_guard hold(mutex_);
    return there_.size();
}

bool TileFolder::has(const std::string& tile) const {
    const std::lock_guard hold(mutex_);
    return there_.contains(tile);
}

Picture TileFolder::read(const std::string& tile) const {
    const FilePlace place(folder_, tile);
    auto picture = read_png(place);
    demand_tile(place, picture.size);  // it may be another file since
    return picture;
}

void TileFolder::write(const std::string& tile, const Picture& picture, const std::atomic<bool>& stop) {
    if (has(tile)) return;
    const FilePlace place(folder_, tile), part = part_of(place);
    if (folder_.entry(part.name).kind == Entry::Kind::file) folder_.remove(part.name);  // of a run that was killed
    write_png(part, picture, {.with_alpha = !picture.is_opaque()}, stop);
    rename_file(part, place);
    const std::lock_guard hold(mutex_);
    there_.insert(tile);
}

}  // namespace doppel
