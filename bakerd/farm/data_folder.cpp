#include "bakerd/farm/data_folder.h"

#include "bakerd/store/owner.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/file.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>

namespace drtv::farm {

std::string_view network_file_system(std::uint32_t magic) {
    constexpr std::uint32_t lustre = 0x0BD00BD0, gpfs = 0x47504653, beegfs = 0x19830326;
    switch (magic) {
        case NFS_SUPER_MAGIC:
            return "NFS";
        case SMB_SUPER_MAGIC:
        case SMB2_SUPER_MAGIC:
        case CIFS_SUPER_MAGIC:
            return "SMB";
        case AFS_SUPER_MAGIC:
        case AFS_FS_MAGIC:
            return "AFS";
        case CEPH_SUPER_MAGIC:
            return "Ceph";
        case lustre:
            return "Lustre";
        case gpfs:
            return "GPFS";
        case beegfs:
            return "BeeGFS";
        default:
            return "";
    }
}

store::Result<std::unique_ptr<DataFolder>> DataFolder::lock(const std::string& path) {
    std::error_code code;
    std::filesystem::create_directories(path, code);
    if (code)
        return store::fail(store::ErrorCode::internal,
                           fmt::format("cannot make the data folder {}: {}", path, code.message()));
    const auto cannot = [&](store::ErrorCode kind, const char* what) {
        return store::fail(kind,
                           fmt::format("cannot {} the data folder {}: {}", what, path, std::strerror(errno)));
    };
    struct statfs system {};
    if (::statfs(path.c_str(), &system) != 0)
        return cannot(store::ErrorCode::internal, "look at");
    if (const auto name = network_file_system(static_cast<std::uint32_t>(system.f_type)); !name.empty())
        return store::fail(
            store::ErrorCode::failed_precondition,
            fmt::format("the data folder {} lies on {}, a network file system, where its database would not "
                        "be safe: take a local folder for --data; --store may be on a network",
                        path,
                        name));
    const std::string lock_path = path + "/lock";
    store::FileDescriptor file(::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!file.is_open())
        return cannot(store::ErrorCode::internal, "write to");
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK)
            return cannot(store::ErrorCode::internal, "lock");
        std::array<char, 32> owner{};
        const ssize_t read = ::read(file.get(), owner.data(), owner.size() - 1);
        return store::fail(store::ErrorCode::failed_precondition,
                           fmt::format("the data folder {} is in use by another bakerd{}",
                                       path,
                                       read > 0 ? fmt::format(" (process {})", owner.data()) : ""));
    }
    const std::string pid = std::to_string(::getpid());
    const auto size = static_cast<ssize_t>(pid.size());
    if (::ftruncate(file.get(), 0) != 0 || ::write(file.get(), pid.data(), pid.size()) != size)
        return cannot(store::ErrorCode::resource_exhausted, "write to");
    return std::unique_ptr<DataFolder>(new DataFolder(path, std::move(file)));
}

store::Result<std::string> DataFolder::id() const {
    const std::string path = path_ + "/id";
    auto known = store::read_mark(path);
    if (!known || !known->empty())
        return known;
    std::random_device random;
    std::string made = fmt::format("{:08x}{:08x}", random(), random());
    if (auto written = store::write_mark(path, made); !written)
        return tl::unexpected(written.error());
    return made;
}

}  // namespace drtv::farm
