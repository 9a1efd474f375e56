#include "confinement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <malloc.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "volume/file_names.h"

namespace pellucid::reader {

namespace {

void limit(decltype(RLIMIT_CORE) what, rlim_t value) {
    rlimit now{};
    getrlimit(what, &now);
    now.rlim_cur = std::min(value, now.rlim_max);
    setrlimit(what, &now);
}

void allowReading(long ruleset, const std::string& path, bool isFolder) {
    const int below = open(path.c_str(), O_PATH | O_CLOEXEC);
    if (below < 0) return;
    landlock_path_beneath_attr rule{};
    rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    if (isFolder) rule.allowed_access |= LANDLOCK_ACCESS_FS_READ_DIR;
    rule.parent_fd = below;
    syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    close(below);
}

/// Files may be opened below `folder` only, and only to be read; and those that links in it lead to.
void allowReadingOnly(const std::string& folder) {
    landlock_ruleset_attr rules{};
    rules.handled_access_fs = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                              LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR |
                              LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                              LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                              LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                              LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;
    const long ruleset = syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0);
    if (ruleset < 0) return; // an older kernel
    allowReading(ruleset, folder, true);
    int left = 100'000;
    anyFileBelow(folder, [&](const std::filesystem::directory_entry& file) {
        std::error_code ec;
        if (file.is_symlink(ec)) allowReading(ruleset, file.path().string(), false);
        return --left == 0;
    });
    syscall(SYS_landlock_restrict_self, ruleset, 0);
    close(static_cast<int>(ruleset));
}

#if defined(__x86_64__)
constexpr unsigned kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr unsigned kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr unsigned kArchitecture = 0;
#endif

/// Calls that nobody needs who reads files, and that could reach beyond this process, fail.
void forbidCalls() {
    if (kArchitecture == 0) return;
    const std::vector<long> forbidden {
        SYS_socket, SYS_socketpair, SYS_connect, SYS_bind, SYS_listen, SYS_accept4, SYS_sendto, SYS_sendmsg, SYS_execve,
            SYS_execveat, SYS_ptrace, SYS_process_vm_readv, SYS_process_vm_writev, SYS_kill, SYS_unlinkat,
            SYS_renameat2, SYS_mkdirat, SYS_mknodat, SYS_linkat, SYS_symlinkat, SYS_fchmodat, SYS_fchmod, SYS_fchownat,
            SYS_fchown, SYS_truncate, SYS_ftruncate, SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, SYS_setns,
            SYS_unshare, SYS_bpf, SYS_keyctl, SYS_add_key, SYS_request_key, SYS_perf_event_open, SYS_init_module,
            SYS_finit_module, SYS_kexec_load, SYS_open_by_handle_at, SYS_userfaultfd, SYS_io_uring_setup, SYS_setuid,
            SYS_setgid, SYS_setresuid, SYS_setresgid, SYS_capset, SYS_shmget, SYS_msgget, SYS_semget,
#if defined(__x86_64__)
            SYS_fork, SYS_vfork, SYS_unlink, SYS_rename, SYS_mkdir, SYS_rmdir, SYS_link, SYS_symlink, SYS_chmod,
            SYS_chown, SYS_creat,
#endif
    };
    std::vector<sock_filter> program{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        // The newer call of the same purpose: its flags lie in memory, which a filter cannot see.
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(SYS_clone3), 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | 38u), // ENOSYS
    };
#if defined(__x86_64__)
    constexpr unsigned kCallsOfX32 = 0x40000000;
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kCallsOfX32, 0, 1));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
#endif
    // A thread of this process is no new one.
    static_assert(std::endian::native == std::endian::little, "the low half of an argument comes first");
    program.insert(program.end(),
                   {BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(SYS_clone), 0, 4),
                    BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args)),
                    BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 0, 1),
                    BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | 1u)});
    for (const long call : forbidden) {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | 1u)); // EPERM
    }
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter);
}

/// Of address space, bytes.
std::uint64_t inUse() {
    std::ifstream in("/proc/self/statm");
    std::uint64_t pages = 0;
    in >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// What it had when files could still be opened, and what it has taken since then by limitMemory().
std::uint64_t& baseBytes() {
    static std::uint64_t bytes = 0;
    return bytes;
}

} // namespace

void confineTo(const std::string& folder) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_DUMPABLE, 0);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    mallopt(M_ARENA_MAX, 1); // each further one reserves what limitMemory() counts
    // What one picture has needed, the next one needs: to give it back and get it anew takes longer than to unpack it.
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    baseBytes() = inUse();
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_NOFILE, 64);
    allowReadingOnly(folder);
    forbidCalls();
}

void limitMemory(std::uint64_t bytes) { limit(RLIMIT_AS, baseBytes() + bytes); }

void limitTime(std::uint64_t bytes) {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    limit(RLIMIT_CPU, static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 4 + bytes / 2'000'000);
}

} // namespace pellucid::reader
