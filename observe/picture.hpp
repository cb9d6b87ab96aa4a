#pragma once
// Grey pictures and their files.
#include <cstdint>
#include <filesystem>
#include <vector>

namespace snag {

struct GreyPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> level;  // [height * width], rows from the top

  std::uint8_t at(int column, int row) const { return level[static_cast<std::size_t>(row) * width + column]; }
};

/// PNG, JPEG, TIFF, BMP or PGM; colours become their brightness. Throws Error(io).
GreyPicture read_picture(const std::filesystem::path& file);
/// The kind follows from the name's ending. Throws Error(io).
void write_picture(const std::filesystem::path& file, const GreyPicture& picture);

/// Pictures of a folder by name, or the file itself. Throws Error(io) if there is none.
std::vector<std::filesystem::path> picture_files(const std::filesystem::path& folder);

/// Mean of pictures of equal size: what does not move. Throws Error(usage) on sizes that differ, naming the file.
GreyPicture mean_picture(const std::vector<std::filesystem::path>& files);

}  // namespace snag
