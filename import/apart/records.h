#pragma once
// The records that a program and its importer exchange: a kind (1 byte), a length (4 bytes, little-endian) and bytes.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace alvor {

/// To the importer go options, files and end; back come chunks and warnings and then end, or missing names and end, or an error.
enum class RecordKind : std::uint8_t {
  options,  ///< v1::ImportOptions
  file,     ///< name of the file whose pieces follow; the first is the scene file
  piece,    ///< further bytes of the file
  end,
  chunk,  ///< v1::GeometryChunk
  warning,
  missing,  ///< name of a file that the scene names
  error     ///< "place: reason"
};

/// Exit status of an importer that the system does not allow to restrict itself.
inline constexpr int exit_unrestricted = 1;

struct Record {
  RecordKind kind = RecordKind::end;
  std::string bytes;
};

/// Reads and writes records. Subclasses move the bytes.
class RecordStream {
 public:
  virtual ~RecordStream() = default;

  /// Returns false if nobody reads any more. Requires: bytes.size() <= largest_record.
  bool write(RecordKind kind, std::string_view bytes);
  /// Writes a file as its name and pieces; false as above.
  bool write_file(std::string_view name, std::string_view bytes);
  /// Returns the next record; nothing if the writer has ended or wrote nonsense.
  std::optional<Record> read();

  static constexpr std::size_t largest_record = std::size_t{1} << 28;

 private:
  /// Move some of the bytes and return their number, or 0 if the other side has ended.
  virtual std::size_t read_some(char* bytes, std::size_t size) = 0;
  virtual std::size_t write_some(const char* bytes, std::size_t size) = 0;

  bool write_all(std::string_view bytes);
  bool read_all(std::string& bytes, std::size_t size);
};

}  // namespace alvor
