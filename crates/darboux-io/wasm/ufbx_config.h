// ufbx in WebAssembly without a C library (UFBX_CONFIG_HEADER of ufbx.h).
//
// Of ufbx, only the reader of FBX is compiled. It allocates through Rust, opens no files, and has no assertions.
// Functions of <math.h> that WebAssembly has no instruction for are those of Rust's library, under the same names.

#ifndef DARBOUX_UFBX_CONFIG_H
#define DARBOUX_UFBX_CONFIG_H

#include <stddef.h>

#define UFBX_MINIMAL
#define UFBX_NO_LIBC
#define UFBX_NO_STDIO
#define UFBX_NO_EXTERNAL_DEFINES

// Every call gives an allocator.
#define ufbx_malloc(size) ((void)(size), (void *)0)
#define ufbx_realloc(block, old_size, new_size) ((void)(block), (void)(old_size), (void)(new_size), (void *)0)
#define ufbx_free(block, old_size) ((void)(block), (void)(old_size))

double sin(double x);
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double pow(double x, double y);

#define ufbx_sin sin
#define ufbx_cos cos
#define ufbx_tan tan
#define ufbx_asin asin
#define ufbx_acos acos
#define ufbx_atan atan
#define ufbx_atan2 atan2
#define ufbx_pow pow

#define ufbx_sqrt __builtin_sqrt
#define ufbx_fabs __builtin_fabs
#define ufbx_copysign __builtin_copysign
#define ufbx_rint __builtin_rint
#define ufbx_floor __builtin_floor
#define ufbx_ceil __builtin_ceil
#define ufbx_isnan __builtin_isnan

// Of a number and a NaN, the number.
static inline double ufbx_fmin(double a, double b) { return b != b || a < b ? a : b; }
static inline double ufbx_fmax(double a, double b) { return b != b || a > b ? a : b; }

#define ufbx_memcpy __builtin_memcpy
#define ufbx_memmove __builtin_memmove
#define ufbx_memset __builtin_memset
#define ufbx_memcmp __builtin_memcmp
#define ufbx_strlen __builtin_strlen

static inline const void *ufbx_memchr(const void *bytes, int value, size_t count)
{
	const unsigned char *at = (const unsigned char *)bytes;
	for (; count > 0; count--, at++) {
		if (*at == (unsigned char)value) return at;
	}
	return NULL;
}

static inline int ufbx_strncmp(const char *a, const char *b, size_t count)
{
	for (; count > 0; count--, a++, b++) {
		if (*a != *b) return *(const unsigned char *)a < *(const unsigned char *)b ? -1 : 1;
		if (*a == 0) return 0;
	}
	return 0;
}

static inline int ufbx_strcmp(const char *a, const char *b) { return ufbx_strncmp(a, b, (size_t)-1); }

#endif
