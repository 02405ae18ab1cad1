#include "cyber_radar/progress.h"

#include <cmath>
#include <cstdio>

namespace radar::tools {

std::string inTime(double seconds) {
  char text[32];
  if (seconds < 9.95) {
    std::snprintf(text, sizeof text, "%.2g s", std::fmax(seconds, 0.001));
    return text;
  }
  const auto whole = std::llround(seconds);
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

std::string progressInWords(const std::string& what, size_t done, size_t total, double seconds) {
  constexpr size_t kWidth = 40;
  const double share = total == 0 ? 1 : static_cast<double>(done) / static_cast<double>(total);
  const auto filled = static_cast<size_t>(kWidth * std::fmin(share, 1));
  std::string text = what + " [" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] " +
                     std::to_string(done) + " of " + std::to_string(total);
  if (done > 0 && done < total) text += ", " + inTime(std::fmax(seconds * (1 / share - 1), 1)) + " left";
  return text;
}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::add(size_t done) {
  done_ += done;
  if (!wanted_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  const double seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
  std::fprintf(stderr, "\r%s\033[K", progressInWords(what_, done_, total_, seconds).c_str());
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace radar::tools
