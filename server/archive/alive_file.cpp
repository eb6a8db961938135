#include "server/archive/alive_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace alvor {

std::chrono::microseconds steady_time() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch());
}

std::optional<RunMoment> AliveFile::read() const {
  std::ifstream in(file_);
  RunMoment moment;
  std::int64_t age = 0;
  if (!(in >> moment.run >> age) || age < 0) return std::nullopt;
  moment.age = std::chrono::microseconds(age);
  return moment;
}

void AliveFile::write(const RunMoment& moment) const {
  std::ostringstream line;
  line << moment.run << ' ' << std::setfill('0') << std::setw(19) << moment.age.count() << '\n';
  const std::string text = line.str();  // as long each time: one write replaces all of it
  const int file = open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0) return;
  [[maybe_unused]] const auto written = pwrite(file, text.data(), text.size(), 0);
  close(file);
}

}  // namespace alvor
