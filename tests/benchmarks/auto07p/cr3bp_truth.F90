! Periodic orbits of the circular restricted three-body problem of cr3bp.F90 in quadruple precision, by shooting: extrapolated midpoint
! rule (Gragg, Bulirsch and Stoer; order 20, 1e-25 a step) of the state and its variation, Newton's method to 1e-20.
!   cr3bp_truth distance   for each line (x y z vx vy vz T) of stdin the largest difference of the state to the nearest periodic orbit, and
!                          of the period: the smallest correction (2-norm, state and period) that closes the orbit
!   cr3bp_truth branch     the period and energy where a pair of multipliers of orbits that begin across the plane y = 0 passes 1, nearest
!                          to each line: (2 - s_1)(2 - s_2) = 0, where s = lambda + 1/lambda; not where a family with the same
!                          symmetry leaves (there these conditions are singular)

MODULE problem
  IMPLICIT NONE
  INTEGER, PARAMETER :: q=SELECTED_REAL_KIND(30), columns=10, n=42
  ! The same double as in the other program: its value, not its decimals, is the parameter.
  REAL(q), PARAMETER :: mu=REAL(0.01215058560962404d0,q)
CONTAINS
  SUBROUTINE field(u,f)
    REAL(q), INTENT(IN) :: u(n)
    REAL(q), INTENT(OUT) :: f(n)
    REAL(q) d1(3),d2(3),s1,s2,g1,g2,a(3,3)
    INTEGER i,j
    d1=u(1:3); d1(1)=d1(1)+mu
    d2=u(1:3); d2(1)=d2(1)-1+mu
    s1=SUM(d1*d1); s2=SUM(d2*d2)
    g1=(1-mu)/(s1*SQRT(s1)); g2=mu/(s2*SQRT(s2))
    f(1:3)=u(4:6)
    f(4:6)=-g1*d1-g2*d2
    f(4)=f(4)+2*u(5)+u(1)
    f(5)=f(5)-2*u(4)+u(2)
    DO j=1,3
       a(:,j)=3*(g1/s1*d1(j)*d1+g2/s2*d2(j)*d2)
       a(j,j)=a(j,j)-g1-g2
    ENDDO
    a(1,1)=a(1,1)+1; a(2,2)=a(2,2)+1
    DO i=6,36,6
       f(i+1:i+3)=u(i+4:i+6)
       f(i+4:i+6)=MATMUL(a,u(i+1:i+3))
       f(i+4)=f(i+4)+2*u(i+5)
       f(i+5)=f(i+5)-2*u(i+4)
    ENDDO
  END SUBROUTINE field

  ! The flow over the time t from z, and its derivative m by z.
  SUBROUTINE flow(z,t,w,m)
    REAL(q), INTENT(IN) :: z(6),t
    REAL(q), INTENT(OUT) :: w(6),m(6,6)
    REAL(q) u(n),f(n),g(n),a(n),b(n),c(n),table(n,columns),row(n,columns),done,step,h,error
    INTEGER i,j,k
    u=0; u(1:6)=z
    DO i=1,6
       u(7*i)=1
    ENDDO
    done=0; step=t/64
    DO WHILE(done<t)
       step=MIN(step,t-done)
       CALL field(u,f)
       DO k=1,columns
          h=step/(2*k)
          a=u; b=u+h*f
          DO i=2,2*k
             CALL field(b,g)
             c=a+2*h*g; a=b; b=c
          ENDDO
          CALL field(b,g)
          row(:,1)=(a+b+h*g)/2
          DO j=2,k
             row(:,j)=row(:,j-1)+(row(:,j-1)-table(:,j-1))/((REAL(k,q)/(k-j+1))**2-1)
          ENDDO
          IF(k==columns)error=MAXVAL(ABS(row(1:6,k)-table(1:6,k-1)))
          table(:,1:k)=row(:,1:k)
       ENDDO
       IF(error<1e-25_q)THEN
          u=table(:,columns); done=done+step
          IF(t-done<1e-28_q)EXIT
       ENDIF
       step=step*MIN(2._q,MAX(.2_q,.8_q*(1e-25_q/(error+1e-40_q))**(1._q/(2*columns-1))))
    ENDDO
    w=u(1:6); m=RESHAPE(u(7:n),(/6,6/))
  END SUBROUTINE flow

  ! Eigenvalues and vectors (columns of v) of a symmetric matrix, by Jacobi's rotations.
  SUBROUTINE eigen(a,v)
    REAL(q), INTENT(INOUT) :: a(6,6)
    REAL(q), INTENT(OUT) :: v(6,6)
    REAL(q) theta,t,c,s,x(6)
    INTEGER i,j,sweep
    v=0
    DO i=1,6
       v(i,i)=1
    ENDDO
    DO sweep=1,30
       DO i=1,5
          DO j=i+1,6
             IF(a(i,j)==0)CYCLE
             theta=(a(j,j)-a(i,i))/(2*a(i,j))
             t=SIGN(1._q,theta)/(ABS(theta)+SQRT(theta**2+1))
             c=1/SQRT(t**2+1); s=t*c
             x=a(:,i); a(:,i)=c*x-s*a(:,j); a(:,j)=s*x+c*a(:,j)
             x=a(i,:); a(i,:)=c*x-s*a(j,:); a(j,:)=s*x+c*a(j,:)
             x=v(:,i); v(:,i)=c*x-s*v(:,j); v(:,j)=s*x+c*v(:,j)
          ENDDO
       ENDDO
    ENDDO
  END SUBROUTINE eigen

  ! The smallest change of (z, t) that closes the orbit, of a closing condition that repeats itself once (the energy).
  SUBROUTINE correct(z,t,change)
    REAL(q), INTENT(IN) :: z(6),t
    REAL(q), INTENT(OUT) :: change(7)
    REAL(q) w(6),m(6,6),a(6,7),s(6,6),v(6,6),f(n),u(n)
    INTEGER i,least
    CALL flow(z,t,w,m)
    u=0; u(1:6)=w
    CALL field(u,f)
    a(:,1:6)=m
    DO i=1,6
       a(i,i)=a(i,i)-1
    ENDDO
    a(:,7)=f(1:6)
    s=MATMUL(a,TRANSPOSE(a))
    CALL eigen(s,v)
    least=MINLOC((/(s(i,i),i=1,6)/),1)
    change=0
    DO i=1,6
       IF(i/=least)change=change-MATMUL(TRANSPOSE(a),v(:,i))*SUM(v(:,i)*(w-z))/s(i,i)
    ENDDO
  END SUBROUTINE correct

  ! y, vx, vz after half a period (those of a planar orbit's that are not 0 in any case), and (2 - s_1)(2 - s_2).
  FUNCTION conditions(p) RESULT(r)
    REAL(q), INTENT(IN) :: p(4)
    REAL(q) r(4),z(6),w(6),m(6,6),t,t2
    INTEGER i
    z=(/p(1),0._q,p(2),0._q,p(3),0._q/)
    CALL flow(z,p(4)/2,w,m)
    r(1:3)=(/w(2),w(4),w(6)/)
    IF(p(2)==0)r(3)=0
    CALL flow(z,p(4),w,m)
    t=-2
    DO i=1,6
       t=t+m(i,i)
    ENDDO
    t2=SUM(m*TRANSPOSE(m))-2
    r(4)=4-2*t+(t*t-t2-4)/2
  END FUNCTION conditions
END MODULE problem

PROGRAM cr3bp_truth
  USE problem
  IMPLICIT NONE
  CHARACTER(16) what
  REAL(q) z(6),t,change(7),total(7),p(4),r(4),ends(4,4),right(4),h,x
  INTEGER i,j,status,tries
  CALL GET_COMMAND_ARGUMENT(1,what)
  DO
     READ(*,*,IOSTAT=status)z,t
     IF(status/=0)EXIT
     IF(what=='distance')THEN
        total=0
        DO tries=1,6
           CALL correct(z+total(1:6),t+total(7),change)
           total=total+change
           IF(MAXVAL(ABS(change))<1e-20_q)EXIT
        ENDDO
        IF(tries>6)STOP 1
        WRITE(*,'(F14.9,2ES12.2)')t,MAXVAL(ABS(total(1:6))),ABS(total(7))
     ELSE
        p=(/z(1),z(3),z(5),t/)
        DO tries=1,12
           r=conditions(p)
           DO j=1,4
              h=1e-14_q
              IF(j==2 .AND. p(2)==0)h=0
              right=p; right(j)=right(j)+h
              IF(h>0)ends(:,j)=(conditions(right)-r)/h
              IF(h==0)ends(:,j)=(/0._q,0._q,1._q,0._q/)
           ENDDO
           right=-r
           DO i=1,4
              j=i-1+MAXLOC(ABS(ends(i:4,i)),1)
              IF(j/=i)THEN
                 ends((/i,j/),:)=ends((/j,i/),:); right((/i,j/))=right((/j,i/))
              ENDIF
              DO j=i+1,4
                 x=ends(j,i)/ends(i,i)
                 ends(j,:)=ends(j,:)-x*ends(i,:); right(j)=right(j)-x*right(i)
              ENDDO
           ENDDO
           DO i=4,1,-1
              right(i)=(right(i)-SUM(ends(i,i+1:4)*right(i+1:4)))/ends(i,i)
           ENDDO
           p=p+right
           IF(MAXVAL(ABS(right))<1e-17_q .OR. MAXVAL(ABS(right))>0.1_q)EXIT
        ENDDO
        IF(tries>12 .OR. MAXVAL(ABS(right))>0.1_q)STOP 1
        WRITE(*,'(2F24.17)')p(4),p(3)**2/2-p(1)**2/2-(1-mu)/SQRT((p(1)+mu)**2+p(2)**2)-mu/SQRT((p(1)-1+mu)**2+p(2)**2)
     ENDIF
  ENDDO
END PROGRAM cr3bp_truth
