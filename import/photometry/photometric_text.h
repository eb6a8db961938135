#pragma once
// Lines and numbers of photometric files, with the line numbers that errors name.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// More angles than any goniometer measures.
constexpr std::size_t most_angles = 10'000;

/// The lines of a text, ended by LF, CRLF or CR, with the white space at both ends removed.
class PhotometricText {
 public:
  explicit PhotometricText(std::string_view text);

  bool is_at_end() const { return next_ >= lines_.size(); }
  /// Returns the next line. `what` tells what the caller needs. Throws ImportError at the end of the file.
  std::string_view line(const char* what);
  /// Returns the next line as a number; a comma counts as a decimal point. Throws ImportError.
  double number_line(const char* what);
  /// Returns the next number of those that blanks, commas and the ends of lines separate. Throws ImportError.
  double number(const char* what);
  /// Returns the next number, which must be a whole one in [low, high]. Throws ImportError.
  std::size_t count(const char* what, std::size_t low, std::size_t high);
  /// Like count(), for a number on a line of its own.
  std::size_t count_line(const char* what, std::size_t low, std::size_t high);
  /// Returns `size` numbers. Throws ImportError, before it takes memory for more than the file can hold.
  std::vector<double> numbers(std::size_t size, const char* what);
  /// Throws ImportError, which names the line read last, if a table of these sizes is larger than a PhotometricWeb may be.
  void require_table(std::size_t planes, std::size_t angles) const;
  /// Returns an intensity, cd, that the line read last told. Throws ImportError if it is negative.
  float intensity(double value) const;
  /// Returns "line 12" for the line that was read last.
  std::string place() const { return "line " + std::to_string(next_); }

 private:
  double parse(std::string_view word, const char* what) const;
  std::size_t whole(double value, const char* what, std::size_t low, std::size_t high) const;

  std::vector<std::string_view> lines_;
  std::size_t next_ = 0;   // line
  std::string_view rest_;  // of the line before `next_`, where numbers are read
};

}  // namespace alvor
