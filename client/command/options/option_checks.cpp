#include "client/command/options/option_checks.h"

#include "client/command/output/numbers.h"

#include <charconv>

namespace alvor {

CLI::Validator above_up_to(double low, double high) {
  const std::string range = "(" + shortest(low) + " - " + shortest(high) + "]";
  return {[=](std::string& text) {
            const auto number = parse_numbers(text, 1);
            const bool fits = number && number->front() > low && number->front() <= high;
            return fits ? std::string() : text + " is not a number in " + range;
          },
          range};
}

CLI::Validator whole_from(std::uint64_t low) {
  const std::string range = "from " + std::to_string(low);
  return {[=](std::string& text) {
            std::uint64_t number = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
            const bool whole = error == std::errc{} && end == text.data() + text.size();
            return whole && number >= low ? std::string() : text + " is not a whole number " + range;
          },
          range};
}

CLI::Validator triple() {
  return {[](std::string& text) { return parse_numbers(text, 3) ? std::string() : text + " is not three numbers like 1,2.5,-3"; },
          ""};
}

}  // namespace alvor
