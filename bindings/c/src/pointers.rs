//! Checked views of the caller's memory. All reads and writes through a caller's pointer are in this file.
//!
//! Checked are: null pointers, alignment, strides, sizes, and address overflow. The true size of the caller's
//! memory cannot be checked.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::mem::MaybeUninit;

use darboux::Strided;

use crate::status::{Error, darboux_status};

/// A C struct whose first field is its size, so that programs and libraries of different versions are
/// compatible.
///
/// # Safety
///
/// The struct is `repr(C)`, its first field is a `usize`, and all zeros are a valid value.
pub(crate) unsafe trait Versioned: Copy {
    /// The name of the struct in C.
    const NAME: &str;
    /// The size of the struct in the version that introduced it, for which a `size` of 0 stands. It is
    /// computed from the last field of that version, so that later fields do not change it.
    const FIRST_SIZE: usize;
}

/// The size of a struct whose last field is a `Last` at `offset`.
pub(crate) const fn size_through<Struct, Last>(offset: usize) -> usize {
    (offset + size_of::<Last>()).next_multiple_of(align_of::<Struct>())
}

/// Copies the struct at `from`. Fields that the caller's version lacks become zero.
///
/// A struct larger than this version's is accepted where all additional bytes are zero. Errors: a null
/// pointer, an invalid size.
///
/// # Safety
///
/// `from` is null or points to as many bytes as the struct's size field gives; where it is 0, to
/// [`Versioned::FIRST_SIZE`] bytes.
pub(crate) unsafe fn read<T: Versioned>(from: *const T) -> Result<T, Error> {
    // SAFETY: the caller's promise.
    let size = unsafe { size_of_struct(from) }?;
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: both have at least so many bytes, and a local value does not overlap the caller's memory.
    unsafe {
        from.cast::<u8>().copy_to_nonoverlapping(value.as_mut_ptr().cast(), size.min(size_of::<T>()));
    }
    // SAFETY: the caller's memory is `size` bytes long.
    let unknown = (size_of::<T>()..size).map(|at| unsafe { from.cast::<u8>().add(at).read() });
    if unknown.into_iter().any(|byte| byte != 0) {
        let message = format!("{} has values that this version of the library does not know", T::NAME);
        return Err(Error::new(darboux_status::StructSize, message));
    }
    // SAFETY: zeros are a valid value, and so are the fields that the caller set.
    Ok(unsafe { value.assume_init() })
}

/// As [`read`]; all zeros where `from` is null.
///
/// # Safety
///
/// As for [`read`].
pub(crate) unsafe fn read_or_zeros<T: Versioned>(from: *const T) -> Result<T, Error> {
    if from.is_null() {
        // SAFETY: zeros are a valid value.
        return Ok(unsafe { MaybeUninit::zeroed().assume_init() });
    }
    // SAFETY: the caller's promise.
    unsafe { read(from) }
}

/// An upper limit for the size of a struct. A larger size field is most likely uninitialised memory.
const LARGEST_STRUCT: usize = 1 << 12;

/// Reads and checks the size field. 0 stands for [`Versioned::FIRST_SIZE`]. Errors: as for [`read`].
///
/// # Safety
///
/// As for [`read`].
unsafe fn size_of_struct<T: Versioned>(at: *const T) -> Result<usize, Error> {
    if at.is_null() {
        return Err(null(T::NAME));
    }
    // SAFETY: every version of the struct begins with its size.
    let size = unsafe { at.cast::<usize>().read_unaligned() };
    match size {
        0 => Ok(T::FIRST_SIZE),
        _ if size < T::FIRST_SIZE || size > LARGEST_STRUCT => {
            let message = format!("{} has size {size}; set it to sizeof({0})", T::NAME);
            Err(Error::new(darboux_status::StructSize, message))
        }
        _ => Ok(size),
    }
}

/// A caller's struct that receives a result.
pub(crate) struct Receiver<T> {
    to: *mut T,
    size: usize,
}

impl<T: Versioned> Receiver<T> {
    /// Errors: a null pointer, an invalid size.
    ///
    /// # Safety
    ///
    /// As for [`read`]; the struct stays writable until the receiver is dropped.
    pub unsafe fn new(to: *mut T) -> Result<Self, Error> {
        // SAFETY: the caller's promise.
        let size = unsafe { size_of_struct(to) }?;
        Ok(Self { to, size: size.min(size_of::<T>()) })
    }

    /// As [`Receiver::new`]; `None` where `to` is null.
    ///
    /// # Safety
    ///
    /// As for [`Receiver::new`].
    pub unsafe fn optional(to: *mut T) -> Result<Option<Self>, Error> {
        // SAFETY: the caller's promise.
        if to.is_null() { Ok(None) } else { unsafe { Self::new(to) }.map(Some) }
    }

    /// Writes the fields that the caller's version has, except the size.
    pub fn put(self, value: T) {
        const SIZE: usize = size_of::<usize>();
        // SAFETY: both have `self.size` bytes, and a local value does not overlap the caller's memory.
        unsafe {
            let from = (&raw const value).cast::<u8>().add(SIZE);
            from.copy_to_nonoverlapping(self.to.cast::<u8>().add(SIZE), self.size - SIZE);
        }
    }
}

/// The slice of `count` integers at `data`, which may be null where `count` is 0. Errors: a null pointer,
/// alignment, a size overflow.
///
/// # Safety
///
/// `data` points to `count` integers, which do not change while the slice is used.
pub(crate) unsafe fn slice<'a, T>(what: &str, data: *const T, count: usize) -> Result<&'a [T], Error> {
    if count == 0 {
        return Ok(&[]);
    }
    let size = size_of::<T>();
    bytes(what, data.cast(), size, size, count)?;
    if !data.is_aligned() {
        let message = format!("{what} must lie at a multiple of {size} bytes");
        return Err(Error::new(darboux_status::Alignment, message));
    }
    // SAFETY: not null, aligned, no longer than `isize::MAX` bytes; the rest is the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(data, count) })
}

/// The bytes of `count` writable elements of `size` bytes. Errors: a null pointer, a size of 0, a size
/// overflow.
///
/// # Safety
///
/// `data` points to as many initialised bytes, which are used by nothing else while the slice exists.
pub(crate) unsafe fn bytes_mut<'a>(
    what: &str,
    data: *mut u8,
    count: usize,
    size: usize,
) -> Result<&'a mut [u8], Error> {
    if size == 0 {
        return Err(Error::new(darboux_status::Stride, format!("the size of {what} is 0 bytes")));
    }
    match bytes(what, data, size, size, count)? {
        0 => Ok(&mut []),
        // SAFETY: not null, no longer than `isize::MAX` bytes; the rest is the caller's promise.
        len => Ok(unsafe { std::slice::from_raw_parts_mut(data, len) }),
    }
}

/// Slices of `count` rows of `width` elements. Rows are `stride` bytes apart (0: packed). Errors: as for
/// [`slice`]; a stride smaller than a row or that leaves rows unaligned.
///
/// # Safety
///
/// `data` points to as many rows, which do not change while the slices are used; every bit pattern is a valid
/// `T`.
pub(crate) unsafe fn row_slices<'a, T: 'a>(
    what: &str,
    data: *const u8,
    count: usize,
    width: usize,
    stride: usize,
) -> Result<impl Iterator<Item = &'a [T]>, Error> {
    let row = width.saturating_mul(size_of::<T>());
    let stride = stride_of(what, stride, row)?;
    bytes(what, data, row, stride, if row == 0 { 0 } else { count })?;
    if !data.cast::<T>().is_aligned() || !stride.is_multiple_of(align_of::<T>()) {
        let message = format!("the rows of {what} must lie at multiples of {} bytes", align_of::<T>());
        return Err(Error::new(darboux_status::Alignment, message));
    }
    let count = if row == 0 { 0 } else { count };
    // SAFETY: not null, aligned, inside the array, whose size was computed without overflow; the rest is the
    // caller's promise.
    Ok((0..count).map(move |at| unsafe { std::slice::from_raw_parts(data.add(at * stride).cast(), width) }))
}

/// Writes a value where `to` is not null.
///
/// # Safety
///
/// `to` is null or writable.
pub(crate) unsafe fn put<T>(to: *mut T, value: T) {
    if !to.is_null() {
        // SAFETY: the caller's promise.
        unsafe { to.write_unaligned(value) }
    }
}

/// A view of `count` elements of `N` floats, `stride` bytes apart (0: packed), with any alignment. `data` may
/// be null where `count` is 0. Errors: a null pointer, a stride smaller than an element, a size overflow.
///
/// # Safety
///
/// `data` points to as many elements, which do not change while the view is used. Bytes between the elements
/// are not read.
pub(crate) unsafe fn strided<'a, const N: usize>(
    what: &str,
    data: *const f32,
    count: usize,
    stride: usize,
) -> Result<Strided<'a, N>, Error> {
    const FLOAT: usize = size_of::<f32>();
    if count == 0 {
        return Ok(Strided::from(&[]));
    }
    let stride = stride_of(what, stride, N * FLOAT)?;
    let len = bytes(what, data.cast(), N * FLOAT, stride, count)?;
    let view = if data.is_aligned() && stride.is_multiple_of(FLOAT) {
        // SAFETY: not null, aligned, no longer than `isize::MAX` bytes; the rest is the caller's promise.
        Strided::from_floats(unsafe { std::slice::from_raw_parts(data, len / FLOAT) }, stride / FLOAT, 0)
    } else {
        // SAFETY: as above; bytes are always aligned.
        Strided::from_bytes(unsafe { std::slice::from_raw_parts(data.cast(), len) }, stride, 0)
    };
    Ok(view?)
}

/// A caller's array that receives results: elements of type `T`, `stride` bytes apart, with any alignment.
pub(crate) struct Output<T> {
    data: *mut u8,
    count: usize,
    stride: usize,
    element: PhantomData<T>,
}

// SAFETY: the array is used by nothing else while the output exists, so any one thread may write it.
unsafe impl<T: Send> Send for Output<T> {}

impl<T: Copy> Output<T> {
    /// The number of elements.
    pub fn len(&self) -> usize {
        self.count
    }

    /// An array of `count` elements, `stride` bytes apart (0: packed). Errors: as for [`strided`].
    ///
    /// # Safety
    ///
    /// `data` points to as many elements, which are used by nothing else while the output exists; `T` has no
    /// padding.
    pub unsafe fn new(what: &str, data: *mut u8, count: usize, stride: usize) -> Result<Self, Error> {
        let stride = stride_of(what, stride, size_of::<T>())?;
        bytes(what, data, size_of::<T>(), stride, count)?;
        Ok(Self { data, count, stride, element: PhantomData })
    }

    /// As [`Output::new`]. Further error: `count` is not `expected`.
    ///
    /// # Safety
    ///
    /// As for [`Output::new`].
    pub unsafe fn expecting(
        expected: usize,
        what: &str,
        data: *mut u8,
        count: usize,
        stride: usize,
    ) -> Result<Self, Error> {
        one_per_corner(what, count, expected)?;
        // SAFETY: the caller's promise.
        unsafe { Self::new(what, data, count, stride) }
    }

    /// Calls `write` with the array where it is packed and aligned; otherwise with `memory`, and copies the
    /// elements from there.
    pub fn fill<R>(
        self,
        memory: &mut Vec<T>,
        write: impl FnOnce(&mut [T]) -> Result<R, darboux::Error>,
    ) -> Result<R, darboux::Error>
    where
        T: Default,
    {
        let first = self.data.cast::<T>();
        if self.count > 0 && self.stride == size_of::<T>() && first.is_aligned() {
            // SAFETY: the promise of `new`; the array has `count` elements.
            unsafe { initialize(first, self.count) };
            // SAFETY: not null, aligned, initialised, no longer than `isize::MAX` bytes; the rest is the
            // promise of `new`.
            return write(unsafe { std::slice::from_raw_parts_mut(first, self.count) });
        }
        memory.resize(self.count, T::default());
        let result = write(memory)?;
        self.copy(memory);
        Ok(result)
    }

    /// Writes the first `count` of `values` in order; a packed array with one copy.
    pub fn copy(self, values: &[T]) {
        if self.stride != size_of::<T>() {
            return self.write(values.iter().copied());
        }
        let size = size_of_val(&values[..self.count.min(values.len())]);
        // SAFETY: the range is inside the array, and `values` is memory of the library.
        unsafe { self.data.copy_from_nonoverlapping(values.as_ptr().cast(), size) }
    }

    /// Writes the first `count` of `values` in order.
    pub fn write(self, values: impl IntoIterator<Item = T>) {
        (0..self.count).zip(values).for_each(|(at, value)| self.set(at, value));
    }

    /// Writes one element. Panics where `at` is out of range.
    pub fn set(&self, at: usize, value: T) {
        assert!(at < self.count);
        // SAFETY: the element is inside the array, whose size was computed without overflow.
        unsafe { self.data.add(at * self.stride).cast::<T>().write_unaligned(value) }
    }
}

/// Makes memory that the caller may never have written valid for a `&mut [T]`, without cost on targets with
/// inline assembly.
///
/// Rust forbids references to uninitialised memory. The compiler must assume that the empty assembly block
/// writes to its pointer, so it treats the memory as initialised. In hardware, the memory holds some bytes in
/// any case.
///
/// # Safety
///
/// `first` points to `count` writable elements, and every bit pattern is a valid `T`.
unsafe fn initialize<T>(first: *mut T, count: usize) {
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    {
        _ = count;
        // SAFETY: the block is empty, and the memory is writable.
        unsafe { std::arch::asm!("/* {0} */", in(reg) first, options(nostack, preserves_flags)) };
    }
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    // SAFETY: the caller's promise; zeros are a valid value.
    unsafe {
        first.write_bytes(0, count);
    }
}

/// Iterates over copies of `count` elements, `stride` bytes apart (0: packed), with any alignment. Errors: as
/// for [`strided`].
///
/// # Safety
///
/// `data` points to as many elements; every bit pattern is a valid `T`.
pub(crate) unsafe fn copied<T: Copy>(
    what: &str,
    data: *const u8,
    count: usize,
    stride: usize,
) -> Result<impl Iterator<Item = T>, Error> {
    let stride = stride_of(what, stride, size_of::<T>())?;
    bytes(what, data, size_of::<T>(), stride, count)?;
    // SAFETY: the element is inside the array, whose size was computed without overflow.
    Ok((0..count).map(move |at| unsafe { data.add(at * stride).cast::<T>().read_unaligned() }))
}

/// A caller's matrix of `count` rows of `width` elements. Rows are `stride` bytes apart (0: packed), with any
/// alignment. Errors: as for [`strided`].
///
/// # Safety
///
/// As for [`copied`]; the memory stays valid while the rows exist.
pub(crate) unsafe fn rows<T: Copy>(
    what: &str,
    data: *const T,
    count: usize,
    width: usize,
    stride: usize,
) -> Result<Rows<T>, Error> {
    let element = width.saturating_mul(size_of::<T>());
    let stride = stride_of(what, stride, element)?;
    bytes(what, data.cast(), element, stride, count)?;
    Ok(Rows { data: data.cast(), count, width, stride, element: PhantomData })
}

/// The result of [`rows`].
pub(crate) struct Rows<T> {
    data: *const u8,
    count: usize,
    width: usize,
    stride: usize,
    element: PhantomData<T>,
}

impl<T: Copy> Rows<T> {
    /// Iterates over the elements of all rows, row by row.
    pub fn elements(&self) -> impl Iterator<Item = T> {
        (0..self.count).flat_map(|row| self.row(row))
    }

    /// Iterates over the elements of one row. Empty where `row` is out of range.
    pub fn row(&self, row: usize) -> impl Iterator<Item = T> {
        let width = if row < self.count { self.width } else { 0 };
        // SAFETY: the element is inside the array, whose size was computed without overflow.
        (0..width)
            .map(move |at| unsafe { self.data.add(row * self.stride).cast::<T>().add(at).read_unaligned() })
    }
}

/// As [`copied`], as a slice: borrowed where the array is packed and aligned, otherwise copied.
///
/// # Safety
///
/// As for [`copied`]; the elements do not change while the slice is used.
pub(crate) unsafe fn gathered<'a, T: Copy>(
    what: &str,
    data: *const u8,
    count: usize,
    stride: usize,
) -> Result<Cow<'a, [T]>, Error> {
    // SAFETY: the caller's promise.
    let elements = unsafe { copied(what, data, count, stride) }?;
    let first = data.cast::<T>();
    let is_slice = count > 0 && (stride == 0 || stride == size_of::<T>()) && first.is_aligned();
    if is_slice {
        // SAFETY: not null, aligned, no longer than `isize::MAX` bytes; the rest is the caller's promise.
        return Ok(Cow::Borrowed(unsafe { std::slice::from_raw_parts(first, count) }));
    }
    Ok(elements.collect())
}

/// As [`gathered`], for a mesh of `corners` corners. Further error: `count` is not `corners`.
///
/// # Safety
///
/// As for [`gathered`].
pub(crate) unsafe fn gathered_of_corners<'a, T: Copy>(
    corners: usize,
    what: &str,
    data: *const u8,
    count: usize,
    stride: usize,
) -> Result<Cow<'a, [T]>, Error> {
    one_per_corner(what, count, corners)?;
    // SAFETY: the caller's promise.
    unsafe { gathered(what, data, count, stride) }
}

fn one_per_corner(what: &str, count: usize, corners: usize) -> Result<(), Error> {
    if count == corners {
        return Ok(());
    }
    let message = format!("there are {count} {what} but the mesh has {corners} corners; give one per corner");
    Err(Error::new(darboux_status::Length, message))
}

/// Allocates the result of `make` and writes its address to `to`. The caller owns the object until
/// [`take_back`]. Errors: null; those of `make`.
///
/// # Safety
///
/// `to` is null or writable.
pub(crate) unsafe fn hand_out<T>(
    what: &str,
    to: *mut *mut T,
    make: impl FnOnce() -> Result<T, Error>,
) -> Result<(), Error> {
    if to.is_null() {
        return Err(null(what));
    }
    let made = Box::into_raw(Box::new(make()?));
    // SAFETY: the caller's promise.
    unsafe { to.write(made) };
    Ok(())
}

/// A reference to an object from [`hand_out`]. Errors: a null pointer.
///
/// # Safety
///
/// `held` is null or from [`hand_out`], and not freed.
pub(crate) unsafe fn held<'a, T>(what: &str, held: *const T) -> Result<&'a T, Error> {
    // SAFETY: the caller's promise.
    unsafe { held.as_ref() }.ok_or_else(|| null(what))
}

/// Frees an object from [`hand_out`]. Does nothing where the pointer is null.
///
/// # Safety
///
/// As for [`held`]; the object is no longer used.
pub(crate) unsafe fn take_back<T>(held: *mut T) {
    if !held.is_null() {
        // SAFETY: the caller's promise.
        drop(unsafe { Box::from_raw(held) });
    }
}

pub(crate) fn null(what: &str) -> Error {
    Error::new(darboux_status::NullPointer, format!("{what} is null"))
}

/// The stride in bytes; 0 stands for the size of an element. Errors: a stride smaller than an element.
fn stride_of(what: &str, stride: usize, element: usize) -> Result<usize, Error> {
    match stride {
        0 => Ok(element),
        _ if stride < element => {
            let message = format!("the stride of {what} is {stride} bytes; an element needs {element}");
            Err(Error::new(darboux_status::Stride, message))
        }
        _ => Ok(stride),
    }
}

/// The size of the array in bytes. Errors: a null pointer, a size overflow.
fn bytes(what: &str, data: *const u8, element: usize, stride: usize, count: usize) -> Result<usize, Error> {
    if count == 0 {
        return Ok(0);
    }
    if data.is_null() {
        return Err(null(what));
    }
    let len = (count - 1).checked_mul(stride).and_then(|start| start.checked_add(element));
    let fits = |len: &usize| isize::try_from(*len).is_ok() && data.addr().checked_add(*len).is_some();
    len.filter(fits).ok_or_else(|| {
        let message =
            format!("{what}: {count} elements, {stride} bytes apart, are more than memory can hold");
        Error::new(darboux_status::TooLarge, message)
    })
}
