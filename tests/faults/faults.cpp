// A disk that fails on demand: a library for LD_PRELOAD that counts the operations which change files below a folder, and spoils one of
// them.
//
//   SNAG_FAULT_FOLDER    operations on files below this folder count (an absolute path without links); without it nothing is changed
//   SNAG_FAULT_PROGRAM   name of the program whose operations count, e.g. "snag" or "snag-mesh"
//   SNAG_FAULT_RANK      rank of the process in which the fault occurs, default 0
//   SNAG_FAULT_LOG       a file outside of the folder, ".RANK" is added: one line "number operation bytes path" for each operation
//   SNAG_FAULT_AT        number of the operation that is spoilt, from 1; 0: none, operations are only counted
//   SNAG_FAULT_FLAG      a file outside of the folder, made when a lasting fault begins: the disk is the same one for all ranks
//   SNAG_FAULT_MODE      kill    SIGKILL before the operation
//                        half    a write writes half of its bytes, any other operation is carried out; then SIGKILL
//                        full    a write writes half of its bytes; from then on nothing can be made or written: "No space left on device"
//                        broken  from then on nothing can be made, written, renamed or flushed: "Input/output error"
//
// Counted are the calls of the C library that make, write, flush, rename, cut or remove files: those of the program itself, of the C++
// library (streams, std::filesystem), of MPI-IO and HDF5, and those of FILE streams. A FILE stream writes inside the C library, where
// nothing can be put in between; fopen() of a counted file therefore returns a stream whose bytes pass through write() here. The C++
// library's own streams need a FILE with a descriptor and call write() themselves: they get a plain one.
#include <aio.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

enum class Mode { none, kill, half, full, broken };
enum class Needs { space, disk };  // what an operation fails for: making and writing need space; the others only a disk that works
enum class Verdict { sound, half, fails };

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

struct Plan {
  std::string folder, flag;
  Mode mode = Mode::none;
  long at = 0;
  int log = -1;
  bool is_watched = false, has_the_fault = false;
  std::atomic<long> n_operations{0};

  Plan() {
    folder = variable("SNAG_FAULT_FOLDER");
    is_watched = !folder.empty() && variable("SNAG_FAULT_PROGRAM") == program_invocation_short_name;
    if (!is_watched) return;
    const auto rank_or_zero = [](const std::string& text) { return text.empty() ? "0" : text; };
    const std::string rank = rank_or_zero(variable("OMPI_COMM_WORLD_RANK"));
    has_the_fault = rank == rank_or_zero(variable("SNAG_FAULT_RANK"));
    flag = variable("SNAG_FAULT_FLAG");
    const std::string name = variable("SNAG_FAULT_MODE");
    mode = name == "kill"     ? Mode::kill
           : name == "half"   ? Mode::half
           : name == "full"   ? Mode::full
           : name == "broken" ? Mode::broken
                              : Mode::none;
    if (has_the_fault) at = std::atol(variable("SNAG_FAULT_AT").c_str());
    if (const std::string file = variable("SNAG_FAULT_LOG"); !file.empty())
      log = static_cast<int>(syscall(SYS_openat, AT_FDCWD, (file + "." + rank).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  }

  bool lasts() const { return mode == Mode::full || mode == Mode::broken; }
};

/// Made at the first call, which may come before the constructors of this library have run.
Plan& plan() {
  static Plan the_plan;
  return the_plan;
}

bool is_below(const std::string& path) {
  const std::string& folder = plan().folder;
  return path.size() >= folder.size() && path.compare(0, folder.size(), folder) == 0 &&
         (path.size() == folder.size() || path[folder.size()] == '/' || path[folder.size()] == ' ');
}

std::string link_target(const std::string& link) {
  char target[PATH_MAX];
  const long length = syscall(SYS_readlinkat, AT_FDCWD, link.c_str(), target, sizeof target);
  return length < 0 ? "" : std::string(target, static_cast<std::size_t>(length));
}

std::string path_of(int descriptor) { return link_target("/proc/self/fd/" + std::to_string(descriptor)); }

std::string absolute(int folder, const char* path) {
  if (path[0] == '/') return path;
  const std::string base = folder == AT_FDCWD ? link_target("/proc/self/cwd") : path_of(folder);
  return base + "/" + (std::strncmp(path, "./", 2) == 0 ? path + 2 : path);
}

/// Counts an operation and says what becomes of it; kills the process where that is due before it.
Verdict judged(const char* operation, const std::string& path, std::size_t bytes, Needs needs) {
  Plan& p = plan();
  const long number = ++p.n_operations;
  if (p.log >= 0) {
    const std::string line = std::to_string(number) + " " + operation + " " + std::to_string(bytes) + " " + path + "\n";
    syscall(SYS_write, p.log, line.c_str(), line.size());
  }
  const bool is_now = p.has_the_fault && number == p.at;
  if (is_now && p.mode == Mode::kill) syscall(SYS_kill, getpid(), SIGKILL);
  if (is_now && p.mode == Mode::half) return Verdict::half;
  if (!p.lasts()) return Verdict::sound;
  if (is_now) syscall(SYS_close, syscall(SYS_openat, AT_FDCWD, p.flag.c_str(), O_WRONLY | O_CREAT, 0666));
  if (!is_now && syscall(SYS_faccessat, AT_FDCWD, p.flag.c_str(), F_OK) != 0) return Verdict::sound;
  if (p.mode == Mode::full && needs != Needs::space) return Verdict::sound;
  return is_now && bytes > 1 && p.mode == Mode::full ? Verdict::half : Verdict::fails;
}

int failed() {
  errno = plan().mode == Mode::full ? ENOSPC : EIO;
  return -1;
}

/// After half of an operation: the end, or a write that says how far it came.
void end_if_killed() {
  if (plan().mode == Mode::half) syscall(SYS_kill, getpid(), SIGKILL);
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// An operation that is carried out as a whole or not at all.
template <class Call>
auto whole(const char* operation, const std::string& path, Needs needs, Call call) -> decltype(call()) {
  if (!plan().is_watched || !is_below(path)) return call();
  const Verdict verdict = judged(operation, path, 0, needs);
  if (verdict == Verdict::fails) return static_cast<decltype(call())>(failed());
  const auto result = call();
  if (verdict == Verdict::half) end_if_killed();
  return result;
}

/// A write of `bytes`; `call(n)` writes the first n of them.
template <class Call>
ssize_t written(const char* operation, int descriptor, std::size_t bytes, Call call) {
  if (!plan().is_watched) return call(bytes);
  const int before = errno;
  const std::string path = path_of(descriptor);
  errno = before;
  if (!is_below(path)) return call(bytes);
  const Verdict verdict = judged(operation, path, bytes, Needs::space);
  if (verdict == Verdict::fails) return failed();
  const ssize_t done = call(verdict == Verdict::half ? bytes / 2 : bytes);
  if (verdict == Verdict::half) end_if_killed();
  return done;
}

std::size_t sum_of(const iovec* parts, int n) {
  std::size_t bytes = 0;
  for (int i = 0; i < n; ++i) bytes += parts[i].iov_len;
  return bytes;
}

/// The first `bytes` of several parts by one write each, from `offset` or (negative) from where the file is.
ssize_t write_parts(int descriptor, const iovec* parts, int n, std::size_t bytes, off_t offset) {
  ssize_t done = 0;
  for (int i = 0; i < n && bytes > 0; ++i) {
    const std::size_t length = std::min(bytes, parts[i].iov_len);
    const long count = offset < 0 ? syscall(SYS_write, descriptor, parts[i].iov_base, length)
                                  : syscall(SYS_pwrite64, descriptor, parts[i].iov_base, length, offset + done);
    if (count < 0) return done > 0 ? done : -1;
    done += count, bytes -= static_cast<std::size_t>(count);
    if (static_cast<std::size_t>(count) < length) break;
  }
  return done;
}

bool changes(int flags) { return (flags & O_ACCMODE) != O_RDONLY || (flags & (O_CREAT | O_TRUNC)) != 0; }

/// Opening for writing; a file that is made needs space.
template <class Call>
int opened(int folder, const char* path, int flags, Call call) {
  if (!plan().is_watched || !changes(flags)) return call();
  const std::string file = absolute(folder, path);
  const bool is_made = (flags & O_CREAT) != 0 && syscall(SYS_faccessat, AT_FDCWD, file.c_str(), F_OK) != 0;
  return whole("open", file, is_made ? Needs::space : Needs::disk, call);
}

ssize_t stream_write(void* cookie, const char* bytes, std::size_t size) {
  const ssize_t done = write(*static_cast<int*>(cookie), bytes, size);
  return done < 0 ? 0 : done;
}
int stream_close(void* cookie) {
  const int descriptor = *static_cast<int*>(cookie);
  delete static_cast<int*>(cookie);
  return close(descriptor);
}

/// The C++ library calls fileno() of its streams.
bool is_cpp_library(void* caller) {
  Dl_info where{};
  return dladdr(caller, &where) != 0 && where.dli_fname && std::strstr(where.dli_fname, "libstdc++");
}

FILE* opened_stream(const char* name, const char* path, const char* how, void* caller) {
  using Function = FILE* (*)(const char*, const char*);
  const bool appends = how[0] == 'a';
  if (!plan().is_watched || (how[0] != 'w' && !appends) || std::strchr(how, '+') || !is_below(absolute(AT_FDCWD, path)))
    return real<Function>(name)(path, how);
  const int descriptor = open(path, O_WRONLY | O_CREAT | O_CLOEXEC | (appends ? O_APPEND : O_TRUNC), 0666);
  if (descriptor < 0) return nullptr;
  if (is_cpp_library(caller)) return fdopen(descriptor, how);
  return fopencookie(new int(descriptor), how, {nullptr, stream_write, nullptr, stream_close});
}

}  // namespace

extern "C" {

#define SNAG_FAULT_MODE_OF(flags)        \
  mode_t mode = 0;                       \
  if ((flags) & (O_CREAT | O_TMPFILE)) { \
    va_list list;                        \
    va_start(list, flags);               \
    mode = va_arg(list, mode_t);         \
    va_end(list);                        \
  }
#define SNAG_FAULT_OPEN(name)                                                                                                \
  int name(const char* path, int flags, ...) {                                                                               \
    SNAG_FAULT_MODE_OF(flags)                                                                                                \
    return opened(AT_FDCWD, path, flags, [&] { return real<int (*)(const char*, int, mode_t)>(#name)(path, flags, mode); }); \
  }
#define SNAG_FAULT_OPENAT(name)                                                                                                         \
  int name(int folder, const char* path, int flags, ...) {                                                                              \
    SNAG_FAULT_MODE_OF(flags)                                                                                                           \
    return opened(folder, path, flags, [&] { return real<int (*)(int, const char*, int, mode_t)>(#name)(folder, path, flags, mode); }); \
  }
SNAG_FAULT_OPEN(open)
SNAG_FAULT_OPEN(open64)
SNAG_FAULT_OPENAT(openat)
SNAG_FAULT_OPENAT(openat64)
int __open_2(const char* path, int flags) { return open(path, flags); }
int __open64_2(const char* path, int flags) { return open(path, flags); }
int __openat_2(int folder, const char* path, int flags) { return openat(folder, path, flags); }
int __openat64_2(int folder, const char* path, int flags) { return openat(folder, path, flags); }
int creat(const char* path, mode_t mode) { return open(path, O_WRONLY | O_CREAT | O_TRUNC, mode); }
int creat64(const char* path, mode_t mode) { return open(path, O_WRONLY | O_CREAT | O_TRUNC, mode); }
FILE* fopen(const char* path, const char* how) { return opened_stream("fopen", path, how, __builtin_return_address(0)); }
FILE* fopen64(const char* path, const char* how) { return opened_stream("fopen64", path, how, __builtin_return_address(0)); }

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  return written("write", descriptor, size, [&](std::size_t n) { return syscall(SYS_write, descriptor, bytes, n); });
}
ssize_t pwrite(int descriptor, const void* bytes, std::size_t size, off_t offset) {
  return written("pwrite", descriptor, size, [&](std::size_t n) { return syscall(SYS_pwrite64, descriptor, bytes, n, offset); });
}
ssize_t pwrite64(int descriptor, const void* bytes, std::size_t size, off_t offset) { return pwrite(descriptor, bytes, size, offset); }
ssize_t writev(int descriptor, const iovec* parts, int n) {
  const std::size_t size = sum_of(parts, n);
  return written("writev", descriptor, size, [&](std::size_t bytes) -> ssize_t {
    return bytes == size ? syscall(SYS_writev, descriptor, parts, n) : write_parts(descriptor, parts, n, bytes, -1);
  });
}
ssize_t pwritev(int descriptor, const iovec* parts, int n, off_t offset) {
  return written("pwritev", descriptor, sum_of(parts, n),
                 [&](std::size_t bytes) { return write_parts(descriptor, parts, n, bytes, offset); });
}
ssize_t pwritev64(int descriptor, const iovec* parts, int n, off_t offset) { return pwritev(descriptor, parts, n, offset); }
int aio_write(aiocb* request) {
  return whole("aio_write", path_of(request->aio_fildes), Needs::space, [&] { return real<int (*)(aiocb*)>("aio_write")(request); });
}
int aio_write64(aiocb64* request) {
  return whole("aio_write", path_of(request->aio_fildes), Needs::space, [&] { return real<int (*)(aiocb64*)>("aio_write64")(request); });
}
ssize_t sendfile(int to, int from, off_t* offset, std::size_t size) {
  return written("sendfile", to, size, [&](std::size_t n) { return syscall(SYS_sendfile, to, from, offset, n); });
}
ssize_t sendfile64(int to, int from, off_t* offset, std::size_t size) { return sendfile(to, from, offset, size); }

int fsync(int descriptor) {
  return whole("fsync", path_of(descriptor), Needs::disk, [&] { return static_cast<int>(syscall(SYS_fsync, descriptor)); });
}
int fdatasync(int descriptor) {
  return whole("fdatasync", path_of(descriptor), Needs::disk, [&] { return static_cast<int>(syscall(SYS_fdatasync, descriptor)); });
}
int ftruncate(int descriptor, off_t length) {
  return whole("ftruncate", path_of(descriptor), length > 0 ? Needs::space : Needs::disk,
               [&] { return static_cast<int>(syscall(SYS_ftruncate, descriptor, length)); });
}
int ftruncate64(int descriptor, off_t length) { return ftruncate(descriptor, length); }
int truncate(const char* path, off_t length) {
  return whole("truncate", absolute(AT_FDCWD, path), length > 0 ? Needs::space : Needs::disk,
               [&] { return static_cast<int>(syscall(SYS_truncate, path, length)); });
}
int truncate64(const char* path, off_t length) { return truncate(path, length); }
int posix_fallocate(int descriptor, off_t offset, off_t length) {
  const int result = whole("fallocate", path_of(descriptor), Needs::space,
                           [&] { return real<int (*)(int, off_t, off_t)>("posix_fallocate")(descriptor, offset, length); });
  return result == -1 ? errno : result;  // it returns its error
}
int posix_fallocate64(int descriptor, off_t offset, off_t length) { return posix_fallocate(descriptor, offset, length); }

int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  return whole("rename", absolute(to_folder, to), Needs::disk,
               [&] { return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, 0)); });
}
int rename(const char* from, const char* to) { return renameat(AT_FDCWD, from, AT_FDCWD, to); }
int unlinkat(int folder, const char* path, int flags) {
  return whole((flags & AT_REMOVEDIR) ? "rmdir" : "unlink", absolute(folder, path), Needs::disk,
               [&] { return static_cast<int>(syscall(SYS_unlinkat, folder, path, flags)); });
}
int unlink(const char* path) { return unlinkat(AT_FDCWD, path, 0); }
int rmdir(const char* path) { return unlinkat(AT_FDCWD, path, AT_REMOVEDIR); }
int remove(const char* path) {
  const int result = unlinkat(AT_FDCWD, path, 0);
  return result != 0 && errno == EISDIR ? unlinkat(AT_FDCWD, path, AT_REMOVEDIR) : result;
}
int mkdirat(int folder, const char* path, mode_t mode) {
  return whole("mkdir", absolute(folder, path), Needs::space, [&] { return static_cast<int>(syscall(SYS_mkdirat, folder, path, mode)); });
}
int mkdir(const char* path, mode_t mode) { return mkdirat(AT_FDCWD, path, mode); }
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  return whole("link", absolute(to_folder, to), Needs::space,
               [&] { return static_cast<int>(syscall(SYS_linkat, from_folder, from, to_folder, to, flags)); });
}
int link(const char* from, const char* to) { return linkat(AT_FDCWD, from, AT_FDCWD, to, 0); }
int symlinkat(const char* target, int folder, const char* path) {
  return whole("symlink", absolute(folder, path), Needs::space,
               [&] { return static_cast<int>(syscall(SYS_symlinkat, target, folder, path)); });
}
int symlink(const char* target, const char* path) { return symlinkat(target, AT_FDCWD, path); }

}  // extern "C"
