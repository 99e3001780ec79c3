// What the sanitizers would say of Fast DDS 2.9.1 itself, which is not ours to mend. Without them nobody
// calls these.

extern "C" {

/// Fast DDS's statistics module deletes an object through a base without a virtual destructor.
const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }

/// Fast DDS locks its timed mutexes with pthread_mutex_clocklock, which GCC 12's thread sanitizer does not
/// see: it reports their unlocking, and orders of locks that it only half knows. It also takes the mapping of
/// a shared-memory segment for a write to the mutexes that another process or thread put there before; only
/// Fast DDS maps memory in these tests. No other data races are suppressed.
const char* __tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
const char* __tsan_default_suppressions() {
  return "mutex:libfastrtps\ndeadlock:libfastrtps\nrace_top:^mmap$\n";
}
}
