#include "record/files/progress.hpp"

#include <algorithm>
#include <cmath>

#include <sys/ioctl.h>
#include <unistd.h>

#include "base/formatted.hpp"

namespace tanktread::output {
namespace {

double share_done(double time, double begin, double end) { return end > begin ? std::clamp((time - begin) / (end - begin), 0.0, 1.0) : 1; }

std::size_t terminal_width(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  if (seconds < 9.95) return formatted("%.1f s", seconds);
  if (whole < 60) return formatted("%ld s", whole);
  if (whole < 3600) return formatted("%ld min %02ld s", whole / 60, whole % 60);
  return formatted("%ld h %02ld min", whole / 3600, whole % 3600 / 60);
}

std::string progress_line(const Moment& moment, double begin, double end, double seconds, int bar) {
  const double done = share_done(moment.time, begin, end);
  std::string line;
  if (bar > 0) {
    const auto filled = static_cast<std::size_t>(done * bar);
    line = "[" + std::string(filled, '#') + std::string(static_cast<std::size_t>(bar) - filled, '-') + "] ";
  }
  line += formatted("%3.0f %%  t %.4g/%.4g  step %d  %d iteration%s  D %.4f", std::floor(100 * done), moment.time, end, moment.step,
                 moment.iterations, moment.iterations == 1 ? "" : "s", moment.deformation);
  if (done > 0 && done < 1) line += "  " + duration(seconds * (1 - done) / done) + " left";
  return line;
}

Progress::Progress(double begin, double end, bool quiet, std::FILE* out)
    : begin_(begin),
      end_(end),
      manner_(quiet                 ? Manner::silent
              : isatty(fileno(out)) ? Manner::bar
                                    : Manner::lines),
      out_(out) {
  printed_.time = begin;
}

Progress::~Progress() { close(); }

bool Progress::due(const Moment& moment, double now) const {
  if (manner_ == Manner::bar) return now - printed_at_ >= 0.1;
  const double since = now - std::max(printed_at_, 0.0);
  const double advance = share_done(moment.time, begin_, end_) - share_done(printed_.time, begin_, end_);
  return since >= 60 || (since >= 3 && advance >= 0.05);
}

void Progress::print(const Moment& moment, double now) {
  const std::size_t width = manner_ == Manner::bar ? terminal_width(out_) : 0;
  std::string line = progress_line(moment, begin_, end_, now, width == 0 ? 0 : width < 100 ? 8 : 24);
  if (manner_ == Manner::bar) {
    line.resize(std::min(line.size(), width - 1));
    std::fprintf(out_, "\r\033[K%s", line.c_str());
  } else {
    std::fprintf(out_, "%s\n", line.c_str());
  }
  std::fflush(out_);
  open_ = manner_ == Manner::bar;
  printed_ = moment;
  printed_at_ = now;
  pending_ = false;
}

void Progress::show(const Moment& moment) {
  if (manner_ == Manner::silent) return;
  last_ = moment;
  pending_ = true;
  const double now = std::chrono::duration<double>(Clock::now() - start_).count();
  if (due(moment, now)) print(moment, now);
}

void Progress::close() {
  if (pending_) print(last_, std::chrono::duration<double>(Clock::now() - start_).count());
  if (open_) std::fputc('\n', out_);
  open_ = false;
}

std::string closing_table(const Phases& phases, const Entries<long>& counts, const std::filesystem::path& results) {
  std::size_t width = 5;
  for (const auto& phase : phases.all()) width = std::max(width, phase.name.size());
  for (const auto& [name, count] : counts) width = std::max(width, name.size());
  const int column = static_cast<int>(width);
  const double total = phases.total();

  std::string text = formatted("  %-*s %10s %6s %10s\n", column, "phase", "seconds", "share", "calls");
  for (const auto& phase : phases.all())
    text += formatted("  %-*s %10.3f %4.0f %% %10ld\n", column, phase.name.c_str(), phase.seconds, total > 0 ? 100 * phase.seconds / total : 0,
                   phase.calls);
  text += formatted("  %-*s %10.3f\n", column, "total", total);
  for (const auto& [name, count] : counts) text += formatted("  %-*s %10ld\n", column, name.c_str(), count);
  return text + "  results in " + results.string() + "\n";
}

}  // namespace tanktread::output
