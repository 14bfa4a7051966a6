//! Pointers to checked views: everything that is read or written through a caller's pointer goes through here.
//!
//! What can be checked is: null, alignment, strides, sizes, that no range wraps around. That memory is as large as a caller says cannot.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::mem::MaybeUninit;

use darboux::{MeshError, Strided};

use crate::status::{Error, darboux_status};

/// A struct whose first field is its size, so that programs and libraries of different versions understand each other.
///
/// # Safety
///
/// `repr(C)`, the first field a `usize`, and all zeros are a value.
pub(crate) unsafe trait Versioned: Copy {
    /// What C calls it.
    const NAME: &str;
    /// Its size in the version that introduced it: what a `size` of 0 stands for. Named by that version's last field, so that fields
    /// which come later do not change it.
    const FIRST_SIZE: usize;
}

/// The size of a struct that ends with a `Last` at `offset`.
pub(crate) const fn size_through<Struct, Last>(offset: usize) -> usize {
    (offset + size_of::<Last>()).next_multiple_of(align_of::<Struct>())
}

/// A copy of the struct at `from`, with zeros for fields that the caller's version does not have.
///
/// A larger one than ours is accepted when what we do not know is zero. Errors: null, a size that is no version's.
///
/// # Safety
///
/// `from` is null or points to as many bytes as the size that stands there says, or to the first version's.
pub(crate) unsafe fn read<T: Versioned>(from: *const T) -> Result<T, Error> {
    // SAFETY: as of this function.
    let size = unsafe { size_of_struct(from) }?;
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: both hold as many bytes, and a local value overlaps nothing of the caller's.
    unsafe {
        from.cast::<u8>().copy_to_nonoverlapping(value.as_mut_ptr().cast(), size.min(size_of::<T>()));
    }
    // SAFETY: the caller's memory is `size` bytes long.
    let unknown = (size_of::<T>()..size).map(|at| unsafe { from.cast::<u8>().add(at).read() });
    if unknown.into_iter().any(|byte| byte != 0) {
        let message = format!("{} has values that this version of the library does not know", T::NAME);
        return Err(Error::new(darboux_status::StructSize, message));
    }
    // SAFETY: zeros are a value, and so are the fields that the caller set.
    Ok(unsafe { value.assume_init() })
}

/// As [`read`], all zeros where `from` is null.
///
/// # Safety
///
/// As of [`read`].
pub(crate) unsafe fn read_or_zeros<T: Versioned>(from: *const T) -> Result<T, Error> {
    if from.is_null() {
        // SAFETY: zeros are a value.
        return Ok(unsafe { MaybeUninit::zeroed().assume_init() });
    }
    // SAFETY: as of this function.
    unsafe { read(from) }
}

/// No version's struct will be larger: a size beyond it is memory that was never set.
const LARGEST_STRUCT: usize = 1 << 12;

/// # Safety
///
/// As of [`read`].
unsafe fn size_of_struct<T: Versioned>(at: *const T) -> Result<usize, Error> {
    if at.is_null() {
        return Err(null(T::NAME));
    }
    // SAFETY: every version begins with its size.
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

/// A caller's struct that a result goes to.
pub(crate) struct Receiver<T> {
    to: *mut T,
    size: usize,
}

impl<T: Versioned> Receiver<T> {
    /// Errors: null, a size that is no version's.
    ///
    /// # Safety
    ///
    /// As of [`read`], and what the pointer points to may be written until the receiver is gone.
    pub unsafe fn new(to: *mut T) -> Result<Self, Error> {
        // SAFETY: as of this function.
        let size = unsafe { size_of_struct(to) }?;
        Ok(Self { to, size: size.min(size_of::<T>()) })
    }

    /// As [`Receiver::new`], none where `to` is null.
    ///
    /// # Safety
    ///
    /// As of [`Receiver::new`].
    pub unsafe fn optional(to: *mut T) -> Result<Option<Self>, Error> {
        // SAFETY: as of this function.
        if to.is_null() { Ok(None) } else { unsafe { Self::new(to) }.map(Some) }
    }

    /// Writes the fields that the caller's version has, but not the size.
    pub fn put(self, value: T) {
        const SIZE: usize = size_of::<usize>();
        // SAFETY: both hold `self.size` bytes, and a local value overlaps nothing of the caller's.
        unsafe {
            let from = (&raw const value).cast::<u8>().add(SIZE);
            from.copy_to_nonoverlapping(self.to.cast::<u8>().add(SIZE), self.size - SIZE);
        }
    }
}

/// `count` integers at `data`, which may be null where there are none. Errors: null, alignment, too many.
///
/// # Safety
///
/// `data` points to as many, which nobody changes while the slice is used.
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
    // SAFETY: not null, aligned, not longer than memory can be, and as of this function.
    Ok(unsafe { std::slice::from_raw_parts(data, count) })
}

/// The bytes of `count` elements of `size` bytes, which may be written. Errors: null, a size of zero, too many.
///
/// # Safety
///
/// `data` points to as many, which nobody else uses until the slice is gone; all their bytes are set.
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
        // SAFETY: not null, not longer than memory can be, and as of this function.
        len => Ok(unsafe { std::slice::from_raw_parts_mut(data, len) }),
    }
}

/// `count` elements of `N` floats, `stride` bytes apart (0: packed), at any alignment. `data` may be null where there are none.
/// Errors: null, a stride that is too small, too many.
///
/// # Safety
///
/// `data` points to as many, which nobody changes while the view is used. What lies between the elements is not read.
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
        // SAFETY: not null, aligned, not longer than memory can be, and as of this function.
        Strided::from_floats(unsafe { std::slice::from_raw_parts(data, len / FLOAT) }, stride / FLOAT, 0)
    } else {
        // SAFETY: as above; bytes are always aligned.
        Strided::from_bytes(unsafe { std::slice::from_raw_parts(data.cast(), len) }, stride, 0)
    };
    Ok(view?)
}

/// A caller's array that results go to: elements of `T`, `stride` bytes apart, at any alignment.
pub(crate) struct Output<T> {
    data: *mut u8,
    count: usize,
    stride: usize,
    element: PhantomData<T>,
}

// SAFETY: nobody else uses the array until the output is gone, so that any one thread may write it.
unsafe impl<T: Send> Send for Output<T> {}

impl<T: Copy> Output<T> {
    /// The number of elements.
    pub fn len(&self) -> usize {
        self.count
    }

    /// An array of `count` elements, `stride` bytes apart (0: packed). Errors as of [`strided`].
    ///
    /// # Safety
    ///
    /// `data` points to as many, which nobody else uses until the output is gone; `T` has no padding.
    pub unsafe fn new(what: &str, data: *mut u8, count: usize, stride: usize) -> Result<Self, Error> {
        let stride = stride_of(what, stride, size_of::<T>())?;
        bytes(what, data, size_of::<T>(), stride, count)?;
        Ok(Self { data, count, stride, element: PhantomData })
    }

    /// As [`Output::new`]. Further error: another count than is expected.
    ///
    /// # Safety
    ///
    /// As of [`Output::new`].
    pub unsafe fn expecting(
        expected: usize,
        what: &str,
        data: *mut u8,
        count: usize,
        stride: usize,
    ) -> Result<Self, Error> {
        one_per_corner(what, count, expected)?;
        // SAFETY: as of this function.
        unsafe { Self::new(what, data, count, stride) }
    }

    /// Calls `write` with the array where it is packed and aligned; else with `memory`, and copies the elements from there.
    pub fn fill<R>(
        self,
        memory: &mut Vec<T>,
        write: impl FnOnce(&mut [T]) -> Result<R, MeshError>,
    ) -> Result<R, MeshError>
    where
        T: Default,
    {
        let first = self.data.cast::<T>();
        if self.count > 0 && self.stride == size_of::<T>() && first.is_aligned() {
            // SAFETY: as of `new`; the memory holds as many elements.
            unsafe { initialize(first, self.count) };
            // SAFETY: not null, aligned, initialised, not longer than memory can be, and as of `new`.
            return write(unsafe { std::slice::from_raw_parts_mut(first, self.count) });
        }
        memory.resize(self.count, T::default());
        let result = write(memory)?;
        self.copy(memory);
        Ok(result)
    }

    /// Writes the elements in order, as many as there is room for; without gaps in one go.
    pub fn copy(self, values: &[T]) {
        if self.stride != size_of::<T>() {
            return self.write(values.iter().copied());
        }
        let size = size_of_val(&values[..self.count.min(values.len())]);
        // SAFETY: within the array, and what is copied is the library's own.
        unsafe { self.data.copy_from_nonoverlapping(values.as_ptr().cast(), size) }
    }

    /// Writes the elements in order, as many as there is room for.
    pub fn write(self, values: impl IntoIterator<Item = T>) {
        (0..self.count).zip(values).for_each(|(at, value)| self.set(at, value));
    }

    /// Writes one element. Panics beyond the last.
    pub fn set(&self, at: usize, value: T) {
        assert!(at < self.count);
        // SAFETY: within the array, whose size was computed without overflow.
        unsafe { self.data.add(at * self.stride).cast::<T>().write_unaligned(value) }
    }
}

/// Makes memory that the caller may never have written valid for a `&mut [T]`, at no cost where there is inline assembly.
///
/// Rust forbids references to uninitialised memory. To the compiler the empty assembly block may write any bytes behind its pointer, so
/// that the memory counts as initialised; in the machine it has some bytes anyway.
///
/// # Safety
///
/// `first` points to `count` elements that may be written, and every bit pattern is a `T`.
unsafe fn initialize<T>(first: *mut T, count: usize) {
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    {
        _ = count;
        // SAFETY: the block is empty; what it could write may be written.
        unsafe { std::arch::asm!("/* {0} */", in(reg) first, options(nostack, preserves_flags)) };
    }
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    // SAFETY: as of this function; zeros are a value.
    unsafe {
        first.write_bytes(0, count);
    }
}

/// The caller's array of `count` elements, copied, `stride` bytes apart (0: packed), at any alignment. Errors as of [`strided`].
///
/// # Safety
///
/// `data` points to as many, of which every bit pattern is a value.
pub(crate) unsafe fn copied<T: Copy>(
    what: &str,
    data: *const u8,
    count: usize,
    stride: usize,
) -> Result<impl Iterator<Item = T>, Error> {
    let stride = stride_of(what, stride, size_of::<T>())?;
    bytes(what, data, size_of::<T>(), stride, count)?;
    // SAFETY: within the array, whose size was computed without overflow.
    Ok((0..count).map(move |at| unsafe { data.add(at * stride).cast::<T>().read_unaligned() }))
}

/// A caller's rows of `width` elements, `stride` bytes apart (0: packed), at any alignment. Errors as of [`strided`].
///
/// # Safety
///
/// As of [`copied`], until the rows are gone.
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

/// What [`rows`] gives.
pub(crate) struct Rows<T> {
    data: *const u8,
    count: usize,
    width: usize,
    stride: usize,
    element: PhantomData<T>,
}

impl<T: Copy> Rows<T> {
    /// The elements of all rows, row after row.
    pub fn elements(&self) -> impl Iterator<Item = T> {
        (0..self.count).flat_map(|row| self.row(row))
    }

    /// The elements of one row; none beyond the last.
    pub fn row(&self, row: usize) -> impl Iterator<Item = T> {
        let width = if row < self.count { self.width } else { 0 };
        // SAFETY: within the array, whose size was computed without overflow.
        (0..width)
            .map(move |at| unsafe { self.data.add(row * self.stride).cast::<T>().add(at).read_unaligned() })
    }
}

/// As [`copied`], as a slice: where it lies if it lies so, else copied.
///
/// # Safety
///
/// As of [`copied`]; nobody changes what `data` points to while the slice is used.
pub(crate) unsafe fn gathered<'a, T: Copy>(
    what: &str,
    data: *const u8,
    count: usize,
    stride: usize,
) -> Result<Cow<'a, [T]>, Error> {
    // SAFETY: as of this function.
    let elements = unsafe { copied(what, data, count, stride) }?;
    let first = data.cast::<T>();
    let is_slice = count > 0 && (stride == 0 || stride == size_of::<T>()) && first.is_aligned();
    if is_slice {
        // SAFETY: not null, aligned, not longer than memory can be, and as of this function.
        return Ok(Cow::Borrowed(unsafe { std::slice::from_raw_parts(first, count) }));
    }
    Ok(elements.collect())
}

/// As [`gathered`], of a mesh of `corners` corners. Further error: another count.
///
/// # Safety
///
/// As of [`gathered`].
pub(crate) unsafe fn gathered_of_corners<'a, T: Copy>(
    corners: usize,
    what: &str,
    data: *const u8,
    count: usize,
    stride: usize,
) -> Result<Cow<'a, [T]>, Error> {
    one_per_corner(what, count, corners)?;
    // SAFETY: as of this function.
    unsafe { gathered(what, data, count, stride) }
}

fn one_per_corner(what: &str, count: usize, corners: usize) -> Result<(), Error> {
    if count == corners {
        return Ok(());
    }
    let message = format!("there are {count} {what} but the mesh has {corners} corners; give one per corner");
    Err(Error::new(darboux_status::Length, message))
}

/// A result that the caller holds by a pointer, until it gives it back to be freed.
///
/// # Safety
///
/// `to` is null or may be written.
pub(crate) unsafe fn hand_out<T>(
    what: &str,
    to: *mut *mut T,
    make: impl FnOnce() -> Result<T, Error>,
) -> Result<(), Error> {
    if to.is_null() {
        return Err(null(what));
    }
    let made = Box::into_raw(Box::new(make()?));
    // SAFETY: as of this function.
    unsafe { to.write(made) };
    Ok(())
}

/// What [`hand_out`] gave. Errors: null.
///
/// # Safety
///
/// `held` is null or from [`hand_out`], and not yet taken back.
pub(crate) unsafe fn held<'a, T>(what: &str, held: *const T) -> Result<&'a T, Error> {
    // SAFETY: as of this function.
    unsafe { held.as_ref() }.ok_or_else(|| null(what))
}

/// Frees what [`hand_out`] gave; nothing where it is null.
///
/// # Safety
///
/// As of [`held`]; nobody uses it any more.
pub(crate) unsafe fn take_back<T>(held: *mut T) {
    if !held.is_null() {
        // SAFETY: as of this function.
        drop(unsafe { Box::from_raw(held) });
    }
}

pub(crate) fn null(what: &str) -> Error {
    Error::new(darboux_status::NullPointer, format!("{what} is null"))
}

/// The stride in bytes. Errors: one that is smaller than an element.
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

/// How many bytes `count` elements take. Errors: null, more than memory can hold.
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
