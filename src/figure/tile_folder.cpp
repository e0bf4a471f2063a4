#include "figure/tile_folder.hpp"

#include "figure/tiles.hpp"
#include "output/png.hpp"

#include <unistd.h>

#include <algorithm>

namespace doppel {
namespace {

namespace fs = std::filesystem;

constexpr const char* mark_name = "pyramid.json";

fs::path claimed(const fs::path& folder, const Json& owner) {
    if (type_of(folder) == fs::file_type::not_found) fs::create_directory(folder);  // another process may, too
    if (type_of(folder) != fs::file_type::directory)
        throw io_failed("{} is no folder; remove it, or give another folder with --out", folder.string());
    const auto text = owner.dump(2) + "\n";
    const auto mark = folder / mark_name, part = folder / fmt::format("{}.{}.part", mark_name, getpid());
    if (start_of_file(mark, 1).empty()) {  // or cut off, where the power failed
        const auto is_mark = [](const std::string& entry) { return entry.starts_with(mark_name); };  // of others, too
        if (!std::ranges::all_of(names_in(folder), is_mark))
            throw io_failed("{} is not a folder of tiles of Doppel's; remove it, or give another folder with --out",
                            folder.string());
        write_file(part, text);
        rename_file(part, mark);
    }
    if (start_of_file(mark, text.size() + 1) != text)
        throw io_failed("{} belongs to another preset or version; remove it, or give another folder with --out",
                        folder.string());
    return folder;
}

/// Throws Error (exit 4) where it is no PNG of a tile's size.
void demand_tile(const fs::path& place, Size size) {
    if (size != Size{Pyramid::tile, Pyramid::tile})
        throw io_failed("{}: has {}x{} px, a tile has {}x{}; remove it", place.string(), size.width, size.height,
                        Pyramid::tile, Pyramid::tile);
}

void demand_no_link(const fs::path& place) {
    if (fs::is_symlink(place)) throw io_failed("{}: cannot be read: it is a symbolic link", place.string());
}

bool is_tile_name(std::string_view name) {
    return name.ends_with(".png") && name.find_first_not_of("0123456789-") == name.size() - 4;
}

}  // namespace

TileFolder::TileFolder(const fs::path& folder, const Json& owner) : folder_(claimed(folder, owner)) {
    for (const auto& tile : names_in(folder_)) {
        if (!is_tile_name(tile)) continue;
        const auto place = folder_ / tile;
        demand_no_link(place);
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
    const auto place = folder_ / tile;
    demand_no_link(place);  // it may be another file since
    auto picture = read_png(place);
    demand_tile(place, picture.size);
    return picture;
}

void TileFolder::write(const std::string& tile, const Picture& picture, const std::atomic<bool>& stop) {
    if (has(tile)) return;
    const auto place = folder_ / tile, part = folder_ / (tile + ".part");
    fs::remove(part);  // of a run that was killed
    write_png(part, picture, {.with_alpha = !picture.is_opaque()}, stop);
    rename_file(part, place);
    const std::lock_guard hold(mutex_);
    there_.insert(tile);
}

}  // namespace doppel
