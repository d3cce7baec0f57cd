#include "bakerd/farm/open_store.h"

#include "bakerd/store/host_name.h"
#include "bakerd/store/owner.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace drtv::farm {

using store::Result;

Result<std::unique_ptr<store::BlobStore>> open_store(const std::string& store_folder,
                                                     const std::string& blob_folder,
                                                     const DataFolder& folder) {
    if (store_folder.empty())
        return store::BlobStore::open(blob_folder);
    const auto id = folder.id();
    if (!id)
        return tl::unexpected(id.error());
    const std::string mark = folder.path() + "/store";
    const auto known = store::read_mark(mark);
    if (!known)
        return tl::unexpected(known.error());
    const bool is_known = *known == store_folder;
    std::error_code code;
    const std::string place =
        fmt::format("{} on {}", std::filesystem::absolute(folder.path(), code).string(), store::host_name());
    if (auto claimed = store::claim_folder(store_folder, *id, place, is_known); !claimed)
        return tl::unexpected(claimed.error());
    if (auto marked = is_known ? Result<void>() : store::write_mark(mark, store_folder); !marked)
        return tl::unexpected(marked.error());
    return store::BlobStore::open(blob_folder);
}

}  // namespace drtv::farm
