/* Wine before 8.5 lacks bcryptprimitives.dll, which every Rust program on Windows asks for random numbers
   to seed its hash maps. This one, beside the program, answers with what Wine has. For tests only. */
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE bytes, SIZE_T length)
{
    return RtlGenRandom(bytes, (ULONG)length);
}
