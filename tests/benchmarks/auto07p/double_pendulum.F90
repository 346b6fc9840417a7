! The ideal double pendulum (m1 = m2 = l1 = l2 = g = 1, angles from the downward vertical) for AUTO-07p:
! U = (th1, th2, w1, w2), L = w1^2 + w2^2/2 + w1 w2 cos(th1 - th2) + 2 cos th1 + cos th2.
! Without QUARTER: periodic orbits (IPS = 2); PAR(1) = mu is the friction -mu w that makes the family of a conservative
! system one-parameter (mu = 0 on it). With QUARTER: a boundary value problem over a quarter of the period (IPS = 4),
! w(0) = 0 and th(T/4) = the equilibrium; PAR(11) = T/4; the environment variable ORBWEAVER_FAMILY (1 to 4) names the family.

SUBROUTINE FUNC(NDIM,U,ICP,PAR,IJAC,F,DFDU,DFDP)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, IJAC, ICP(*)
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(OUT) :: F(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM,*), DFDP(NDIM,*)
  DOUBLE PRECISION s1,c1,s2,c2,s,c,w1,w2,mu,g1,g2,di,a1,a2,n1,n2,dd,g1x(4),g2x(4),dc(2)
#ifdef QUARTER
  DOUBLE PRECISION tt,fs(4)
#endif
  INTEGER j

  s1=SIN(U(1)); c1=COS(U(1)); s2=SIN(U(2)); c2=COS(U(2))
  s=s1*c2-c1*s2; c=c1*c2+s1*s2
  w1=U(3); w2=U(4); mu=PAR(1)
  ! M a = g with M = [[2, c], [c, 1]]
  g1=-w2*w2*s-2*s1-mu*w1
  g2= w1*w1*s-s2-mu*w2
  di=1/(2-c*c)
  a1=(g1-c*g2)*di
  a2=(2*g2-c*g1)*di
  F(1:4)=(/ w1, w2, a1, a2 /)
#ifdef QUARTER
  tt=PAR(11)
  fs=F(1:4)
  F(1:4)=tt*fs
#endif
  IF(IJAC==0)RETURN

  g1x=(/ -w2*w2*c-2*c1,  w2*w2*c, -mu, -2*w2*s /)
  g2x=(/  w1*w1*c, -w1*w1*c-c2, 2*w1*s, -mu /)
  dc=(/ -s, s /)
  DFDU(1:2,1:4)=0
  DFDU(1,3)=1
  DFDU(2,4)=1
  DO j=1,4
     n1=g1x(j)-c*g2x(j)
     n2=2*g2x(j)-c*g1x(j)
     IF(j<=2)THEN
        dd=2*c*dc(j)
        n1=n1-dc(j)*g2+a1*dd
        n2=n2-dc(j)*g1+a2*dd
     ENDIF
     DFDU(3,j)=n1*di
     DFDU(4,j)=n2*di
  ENDDO
#ifdef QUARTER
  DFDU(1:4,1:4)=tt*DFDU(1:4,1:4)
#endif
  IF(IJAC==1)RETURN
#ifdef QUARTER
  DFDP(1:4,11)=fs
#else
  DFDP(1:2,1)=0
  DFDP(3,1)=(-w1+c*w2)*di
  DFDP(4,1)=(-2*w2+c*w1)*di
#endif
END SUBROUTINE FUNC

SUBROUTINE STPNT(NDIM,U,PAR,T)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(IN) :: T
#ifdef QUARTER
  DOUBLE PRECISION, PARAMETER :: pi=3.14159265358979324d0, r2=1.41421356237309505d0
  DOUBLE PRECISION om,v(2),e(2)
  INTEGER, SAVE :: family=0
  CHARACTER(16) text
  IF(family==0)THEN
     CALL GET_ENVIRONMENT_VARIABLE('ORBWEAVER_FAMILY',text)
     READ(text,*)family
  ENDIF
  e=0
  SELECT CASE(family)
  CASE(1); om=SQRT(2-r2); v=(/1d0,r2/)
  CASE(2); om=SQRT(2+r2); v=(/1d0,-r2/)
  CASE(3); om=SQRT(r2); v=(/1d0,2-r2/); e=(/0d0,pi/)
  CASE(4); om=SQRT(r2); v=(/1d0,2+r2/); e=(/pi,0d0/)
  END SELECT
  v=v*1d-2
  PAR(1)=0; PAR(11)=pi/2/om; PAR(14:15)=e
  U(1:2)=e+v*COS(pi/2*T); U(3:4)=-om*v*SIN(pi/2*T)
#else
  PAR(1)=0
  U=0
#endif
END SUBROUTINE STPNT

SUBROUTINE PVLS(NDIM,U,PAR)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: PAR(*)
#ifndef QUARTER
  DOUBLE PRECISION, EXTERNAL :: GETP
  INTEGER i,j
#endif
  PAR(3)=U(3)**2+U(4)**2/2+U(3)*U(4)*COS(U(1)-U(2))-2*COS(U(1))-COS(U(2))
#ifndef QUARTER
  ! Periods of the small oscillations around an equilibrium, shorter eigenvalues' later: PAR(6), PAR(7).
  IF(GETP('NTS',0,U)<=1.5d0 .OR. ABS(U(3))+ABS(U(4))<1d-14)THEN
     j=6
     DO i=1,4
        IF(GETP('EIG',2*i,U)>1d-5 .AND. ABS(GETP('EIG',2*i-1,U))<1d-6 .AND. j<=7)THEN
           PAR(j)=8*ATAN(1d0)/GETP('EIG',2*i,U)
           j=j+1
        ENDIF
     ENDDO
  ENDIF
#endif
END SUBROUTINE PVLS

SUBROUTINE BCND(NDIM,PAR,ICP,NBC,U0,U1,FB,IJAC,DBC)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, ICP(*), NBC, IJAC
  DOUBLE PRECISION, INTENT(IN) :: PAR(*), U0(NDIM), U1(NDIM)
  DOUBLE PRECISION, INTENT(OUT) :: FB(NBC)
  DOUBLE PRECISION, INTENT(INOUT) :: DBC(NBC,*)
#ifdef QUARTER
  FB(1:2)=U0(3:4)
  FB(3:4)=U1(1:2)-PAR(14:15)
  IF(IJAC==0)RETURN
  DBC(1:4,1:2*NDIM)=0
  DBC(1,3)=1; DBC(2,4)=1
  DBC(3,NDIM+1)=1; DBC(4,NDIM+2)=1
  IF(IJAC==1)RETURN
  DBC(1:4,2*NDIM+1:2*NDIM+16)=0
#endif
END SUBROUTINE BCND

SUBROUTINE ICND
END SUBROUTINE ICND

SUBROUTINE FOPT
END SUBROUTINE FOPT
