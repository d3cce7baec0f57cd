// The version of this library. docs/versions.md says what each of these numbers promises; while the major
// version is 0, a new minor version may break source and binary compatibility.
#pragma once

#define DRTV_VERSION_MAJOR 0
#define DRTV_VERSION_MINOR 1
#define DRTV_VERSION_PATCH 0

// The newest minor version of the file format 1.x that this library writes and knows. It also reads files of
// newer minor versions, without the sections that those added.
#define DRTV_FORMAT_MINOR 3

#define DRTV_VERSION_TEXT_OF(x) #x
#define DRTV_VERSION_TEXT(x) DRTV_VERSION_TEXT_OF(x)

// "0.1.0"
#define DRTV_VERSION                      \
    DRTV_VERSION_TEXT(DRTV_VERSION_MAJOR) \
    "." DRTV_VERSION_TEXT(DRTV_VERSION_MINOR) "." DRTV_VERSION_TEXT(DRTV_VERSION_PATCH)
