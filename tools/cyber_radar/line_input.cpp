#include "cyber_radar/line_input.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr size_t kEnough = size_t{4} << 20, kLongest = size_t{64} << 20, kRead = size_t{1} << 20;

}  // namespace

LineInput::LineInput(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)), room_(kRead) {
  // A fast writer then leaves more than the 64 KiB of a pipe while a batch is answered. Where this fails, it leaves
  // less.
  fcntl(descriptor_, F_SETPIPE_SZ, kRead);
}

void LineInput::read() {
  ssize_t count = 0;
  do {
    count = ::read(descriptor_, room_.data(), room_.size());
  } while (count < 0 && errno == EINTR);
  if (count < 0) {
    throw InputError(name_, "", "expected lines, one for each query, got an error: " + std::string(strerror(errno)));
  }
  rest_.append(room_.data(), static_cast<size_t>(count));
  isEnd_ = count == 0;
}

bool LineInput::hasMore() const {
  pollfd asked{descriptor_, POLLIN, 0};
  return poll(&asked, 1, 0) > 0;
}

std::vector<std::string> LineInput::next() {
  before_ += std::exchange(last_, 0);
  size_t searched = 0;
  // Waits until there is a line.
  while (!isEnd_ && rest_.find('\n', searched) == rest_.npos) {
    searched = rest_.size();
    if (searched > kLongest) throw InputError(placeOf(0), "", "expected a line of at most 64 MiB, got more");
    read();
  }
  while (!isEnd_ && rest_.size() < kEnough && hasMore()) read();
  std::vector<std::string> lines;
  size_t begin = 0;
  for (size_t end = 0; (end = rest_.find('\n', begin)) != rest_.npos; begin = end + 1) {
    lines.push_back(rest_.substr(begin, end - begin));
  }
  rest_.erase(0, begin);
  if (isEnd_ && !rest_.empty()) lines.push_back(std::exchange(rest_, ""));
  last_ = lines.size();
  return lines;
}

}  // namespace radar::tools
