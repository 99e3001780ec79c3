#pragma once

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace fleetmap::testing {

/// A child process. Its output is kept in memory, so that it tells of a full disk too. Killed when destroyed.
class Process {
 public:
  explicit Process(const std::vector<std::string>& arguments) : output_(memfd_create("output", MFD_CLOEXEC)) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is cut off leaves no agents behind
      dup2(output_, STDOUT_FILENO);
      dup2(output_, STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (!exit_code_) {
      signal(SIGKILL);
      wait();
    }
    close(output_);
  }

  void signal(int number) const { ::kill(pid_, number); }
  /// Exit code, or 128 + the signal that ended it.
  int wait() {
    int status = 0;
    if (!exit_code_ && waitpid(pid_, &status, 0) == pid_) {
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return exit_code_.value_or(-1);
  }
  bool running() {
    int status = 0;
    if (!exit_code_ && waitpid(pid_, &status, WNOHANG) == pid_) {
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return !exit_code_;
  }
  std::string output() const {
    std::string text(static_cast<std::size_t>(std::max<off_t>(0, lseek(output_, 0, SEEK_CUR))), '\0');
    const ssize_t size = pread(output_, text.data(), text.size(), 0);
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, size)));
    return text;
  }

 private:
  int output_;  ///< both write at the child's place in it
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace fleetmap::testing
