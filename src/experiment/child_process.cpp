#include "child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <thread>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::experiment {
namespace {

/// Between fork() and exec only what is safe beside other threads.
[[noreturn]] void become(const char* program, char* const* argv, int log, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(126);
  ::setpgid(0, 0);  // Ctrl-C reaches the experiment alone, which ends its children in order
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  ::execv(program, argv);
  ::_exit(127);
}

ChildExit exit_of(int status, const rusage& use) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  ChildExit result;
  result.signalled = WIFSIGNALED(status);
  result.code = result.signalled ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  result.cpu_seconds = seconds(use.ru_utime) + seconds(use.ru_stime);
  result.peak_megabytes = static_cast<double>(use.ru_maxrss) / 1024.0;
  return result;
}

/// Once `stop` is set the child is asked to end, and `patience` later made to.
Result<ChildExit> wait_for(pid_t child, const std::atomic<bool>& stop, std::chrono::seconds patience) {
  using Clock = std::chrono::steady_clock;
  Clock::time_point asked{};
  for (;;) {
    int status = 0;
    rusage use{};
    const pid_t ended = ::wait4(child, &status, WNOHANG, &use);
    if (ended == child) return exit_of(status, use);
    if (ended < 0 && errno != EINTR)
      return failure(std::string("waiting for a case: ") + std::strerror(errno));
    if (stop && asked == Clock::time_point{}) {
      ::kill(child, SIGTERM);
      asked = Clock::now();
    } else if (asked != Clock::time_point{} && Clock::now() - asked > patience) {
      ::kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

Result<ChildExit> run(const char* program, const std::string& name, const std::vector<std::string>& arguments,
                      const std::filesystem::path& log, const std::atomic<bool>& stop,
                      std::chrono::seconds patience) {
  std::vector<std::string> copies{name};
  copies.insert(copies.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (output < 0) return failure(log.string() + ": " + std::strerror(errno));
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(program, argv.data(), output, parent);
  ::close(output);
  if (child < 0) return failure(std::string("a case cannot be started: ") + std::strerror(errno));
  return wait_for(child, stop, patience);
}

}  // namespace

Result<ChildExit> run_self(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                           const std::atomic<bool>& stop) {
  return run("/proc/self/exe", "fleetmap", arguments, log, stop, std::chrono::seconds(2));
}

Result<ChildExit> run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                              const std::filesystem::path& log, const std::atomic<bool>& stop) {
  return run(program.c_str(), program.string(), arguments, log, stop, std::chrono::seconds(60));
}

Status check_exit(const Result<ChildExit>& ended, const std::string& what, const std::filesystem::path& log) {
  if (!ended) return tl::unexpected(ended.error());
  if (ended->code == 0) return {};
  const std::string how = ended->signalled ? "was ended by signal " + std::to_string(ended->code - 128)
                                           : "exited with " + std::to_string(ended->code);
  return failure(what + " " + how + ":\n" + tail_of(log, 6));
}

std::string tail_of(const std::filesystem::path& log, std::size_t lines) {
  std::ifstream in(log);
  std::deque<std::string> last;
  for (std::string line; std::getline(in, line);) {
    last.push_back(line.substr(0, 500));
    if (last.size() > lines) last.pop_front();
  }
  std::string text;
  for (const std::string& line : last) append_to_list(text, line, "\n");
  return text;
}

}  // namespace fleetmap::experiment
